// Words and numbers of a text format, with the line for whoever has to mend the file.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/error.h"

namespace lastflat {

class TextScanner {
public:
    /// `format` stands in every message, before the line.
    TextScanner(std::string_view text, std::string_view format) : rest_(text), format_(format) {}

    /// The next word, whatever line it is on; empty at the end.
    [[nodiscard]] std::string_view next_word() {
        skip_space();
        const std::string_view word = rest_.substr(0, rest_.find_first_of(white));
        rest_.remove_prefix(word.size());
        return word;
    }
    /// What is left of the current line, without spaces around it; the next line is then current.
    [[nodiscard]] std::string_view rest_of_line() {
        const auto end = rest_.find('\n');
        std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
        if (end != std::string_view::npos) ++line_;
        const auto first = line.find_first_not_of(white);
        if (first == std::string_view::npos) return {};
        return line.substr(first, line.find_last_not_of(white) + 1 - first);
    }
    [[nodiscard]] double next_number() {
        std::string_view word = next_word();
        const std::string_view whole = word;
        if (!word.empty() && word.front() == '+') word.remove_prefix(1);
        double value = 0.0;
        const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (word.empty() || status != std::errc() || end != word.data() + word.size())
            fail("'" + std::string(whole.substr(0, 40)) + "' is not a number");
        if (!std::isfinite(value)) fail("a number is not finite");
        return value;
    }
    [[nodiscard]] std::uint64_t next_count() {
        const std::string_view word = next_word();
        std::uint64_t value = 0;
        const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (word.empty() || status != std::errc() || end != word.data() + word.size())
            fail("'" + std::string(word.substr(0, 40)) + "' is not a count or an index");
        return value;
    }
    [[nodiscard]] bool at_end() {
        skip_space();
        return rest_.empty();
    }
    /// The bytes after what was read.
    [[nodiscard]] std::string_view rest() const { return rest_; }

    [[noreturn]] void fail(const std::string& what,
                           ErrorCode code = ErrorCode::unreadable_model) const {
        throw Error(code, std::string(format_) + " line " + std::to_string(line_) + ": " + what);
    }

private:
    static constexpr std::string_view white = " \t\r\n\f\v";
    void skip_space() {
        const auto first = std::min(rest_.find_first_not_of(white), rest_.size());
        for (const char c : rest_.substr(0, first)) line_ += c == '\n' ? 1 : 0;
        rest_.remove_prefix(first);
    }

    std::string_view rest_, format_;
    std::size_t line_ = 1;
};

}  // namespace lastflat
