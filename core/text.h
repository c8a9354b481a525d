// Numbers as text, for files and for people: the digits that printf gives, in a tenth of its time
// and in no locale.
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace lastflat {

inline void append_number(std::string& text, double value, std::chars_format format,
                          int precision) {
    std::array<char, 512> digits;
    const auto written =
        std::to_chars(digits.data(), digits.data() + digits.size(), value, format, precision);
    text.append(digits.data(), written.ptr);
}

/// As printf's %.<decimals>f.
inline void append_fixed(std::string& text, double value, int decimals) {
    append_number(text, value, std::chars_format::fixed, decimals);
}

/// As printf's %.<decimals>f.
[[nodiscard]] inline std::string fixed_text(double value, int decimals) {
    std::string text;
    append_fixed(text, value, decimals);
    return text;
}

/// As printf's %.<digits>g.
[[nodiscard]] inline std::string general_text(double value, int digits) {
    std::string text;
    append_number(text, value, std::chars_format::general, digits);
    return text;
}

}  // namespace lastflat
