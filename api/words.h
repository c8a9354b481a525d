// The words of the wire, each beside the value that it stands for.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace lastflat::api {

/// A line of an enum's table. A table is an array of them; nothing depends on its order.
template <class Value>
struct Word {
    std::string_view word;
    Value value;
};

/// Throws: std::logic_error if the table has no word for the value.
template <class Value, std::size_t size>
[[nodiscard]] constexpr std::string_view word_of(const Word<Value> (&table)[size], Value value) {
    for (const auto& line : table) {
        if (line.value == value) return line.word;
    }
    throw std::logic_error("a value has no word on the wire");
}

template <class Value, std::size_t size>
[[nodiscard]] constexpr std::optional<Value> value_of(const Word<Value> (&table)[size],
                                                      std::string_view word) {
    for (const auto& line : table) {
        if (line.word == word) return line.value;
    }
    return std::nullopt;
}

/// "queued, running": for people.
template <class Value, std::size_t size>
[[nodiscard]] std::string listed(const Word<Value> (&table)[size]) {
    std::string list;
    for (const auto& line : table) list.append(list.empty() ? "" : ", ").append(line.word);
    return list;
}

}  // namespace lastflat::api
