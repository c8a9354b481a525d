// Small questions about bytes from outside, shared by the readers of heads and bodies.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace lastflat::http {

constexpr std::string_view line_end = "\r\n";

[[nodiscard]] std::string lower_case(std::string_view text);

/// Without the spaces and tabs at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// A token of RFC 9110: not empty, letters, digits and !#$%&'*+-.^_`|~ only.
[[nodiscard]] bool is_token(std::string_view text);

[[nodiscard]] bool has_control_characters(std::string_view text);

/// Nothing if a '%' is not followed by two hexadecimal digits.
[[nodiscard]] std::optional<std::string> percent_decoded(std::string_view text, bool plus_is_space);

/// Everything but letters, digits and -._~ encoded.
[[nodiscard]] std::string percent_encoded(std::string_view text);

/// "type/subtype" in lower case of a Content-Type value; empty if there is none.
[[nodiscard]] std::string media_type_of(std::string_view content_type);

/// A parameter of a value such as `form-data; name="a;b"; filename=c`: tokens and quoted strings in
/// any order, names in any case. In quoted strings only \" and \\ are escapes: browsers and old
/// clients send file names with lone backslashes.
[[nodiscard]] std::optional<std::string> parameter_of(std::string_view value,
                                                      std::string_view name);

}  // namespace lastflat::http
