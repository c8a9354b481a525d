// JSON from outside to values, once: every error names the field, and what nobody reads is refused.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "api/nearest_name.h"
#include "api/refusal.h"
#include "api/words.h"

namespace lastflat::api {

/// mm; no last is a kilometre long.
constexpr double far_away = 1e6;

/// The request breaks the contract. `pointer` (RFC 6901) names the field; empty: the whole
/// document. `what()` does not repeat it.
class InvalidRequest : public Refusal {
public:
    InvalidRequest(const std::string& pointer, const std::string& detail)
        : Refusal({"invalid_request", (pointer.empty() ? "the request" : pointer) + ": " + detail},
                  detail) {
        problem_.pointer = pointer;
    }
    [[nodiscard]] const std::string& pointer() const { return *problem_.pointer; }
};

/// A document of at most `depth` levels, 4 million values, names, lists and objects, and 32 MiB
/// beside what stands in strings, without repeated names. It is gone through once before anything
/// is built.
/// Throws: InvalidRequest saying where reading stopped.
[[nodiscard]] nlohmann::json parse_json(std::string_view text, int depth);

/// `pointer` extended by one step.
[[nodiscard]] std::string step(const std::string& pointer, const std::string& name);

/// One JSON value and where it stands.
struct Field {
    const nlohmann::json& value;
    std::string pointer;

    [[noreturn]] void fail(const std::string& what) const { throw InvalidRequest(pointer, what); }
    /// Valid UTF-8 without control characters, 1 to `bytes` bytes.
    [[nodiscard]] std::string text(std::size_t bytes) const;
    [[nodiscard]] double number(double least, double most) const;
    [[nodiscard]] std::int32_t index() const;
    [[nodiscard]] std::vector<Field> items(std::size_t most) const;
    /// Names and values of an object whose names are free.
    [[nodiscard]] std::vector<std::pair<std::string, Field>> entries(std::size_t most) const;
    /// What one of the table's words stands for.
    template <class Value, std::size_t size>
    [[nodiscard]] Value choice(const Word<Value> (&table)[size]) const {
        if (!value.is_string()) fail("must be one of: " + listed(table));
        const auto& word = value.get_ref<const std::string&>();
        if (const auto found = value_of(table, word)) return *found;
        std::vector<std::string> words;
        for (const auto& line : table) words.emplace_back(line.word);
        fail("must be one of: " + listed(table) + suggestion(word, words));
    }
};

/// Reads the members of an object by name.
class ObjectReader {
public:
    explicit ObjectReader(Field field);
    [[nodiscard]] std::optional<Field> find(const std::string& name);
    /// Throws: InvalidRequest naming the first member that was never looked for.
    void finish() const;
    [[nodiscard]] const Field& field() const { return field_; }

private:
    [[noreturn]] void fail_unknown(const std::string& name) const;

    Field field_;
    std::set<std::string> known_;
};

}  // namespace lastflat::api
