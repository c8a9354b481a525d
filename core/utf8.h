// Text from outside, whatever wrote it, as UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace lastflat {

/// Well-formed UTF-8: no surrogates, no overlong forms, nothing above U+10FFFF.
[[nodiscard]] bool is_utf8(std::string_view text);

/// The text itself if it is UTF-8; else every byte is a character of Latin-1.
[[nodiscard]] std::string as_utf8(std::string_view text);

}  // namespace lastflat
