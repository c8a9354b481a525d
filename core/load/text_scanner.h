// Words and numbers of a text format, with the line for whoever has to mend the file.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/error.h"

namespace lastflat {

/// Takes the first line away, and returns it without its end: LF, CR LF or CR.
[[nodiscard]] inline std::string_view take_line(std::string_view& text) {
    const auto is_end = [](char c) { return c == '\n' || c == '\r'; };
    const auto size =
        static_cast<std::size_t>(std::find_if(text.begin(), text.end(), is_end) - text.begin());
    const std::string_view line = text.substr(0, size);
    text.remove_prefix(size);
    if (text.substr(0, 2) == "\r\n") {
        text.remove_prefix(2);
    } else if (!text.empty()) {
        text.remove_prefix(1);
    }
    return line;
}

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
        const std::size_t before = rest_.size();
        const std::string_view line = take_line(rest_);
        if (line.size() < before) ++line_;
        const auto first = line.find_first_not_of(white);
        if (first == std::string_view::npos) return {};
        return line.substr(first, line.find_last_not_of(white) + 1 - first);
    }
    /// What is left of the current line, which stays the current one.
    [[nodiscard]] std::string_view peek_line() const {
        std::string_view rest = rest_;
        return TextScanner(take_line(rest), format_).rest_of_line();
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

    [[nodiscard]] std::size_t line() const { return line_; }

    [[noreturn]] void fail(const std::string& what,
                           ErrorCode code = ErrorCode::unreadable_model) const {
        throw Error(code, std::string(format_) + " line " + std::to_string(line_) + ": " + what);
    }

private:
    static constexpr std::string_view white = " \t\r\n\f\v";
    void skip_space() {
        const auto first = std::min(rest_.find_first_not_of(white), rest_.size());
        for (std::size_t i = 0; i < first; ++i) {
            const bool is_pair = rest_.substr(i, 2) == "\r\n";
            line_ += !is_pair && (rest_[i] == '\n' || rest_[i] == '\r') ? 1 : 0;
        }
        rest_.remove_prefix(first);
    }

    std::string_view rest_, format_;
    std::size_t line_ = 1;
};

}  // namespace lastflat
