// Base64 and base64url (RFC 4648).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace lastflat::api {

/// The bytes; nothing if the text is not base64 of either alphabet. Padding may be left out; white
/// space is not allowed.
[[nodiscard]] std::optional<std::string> decode_base64(std::string_view text);

/// base64 with padding.
[[nodiscard]] std::string encode_base64(std::string_view bytes);
/// base64url without padding.
[[nodiscard]] std::string encode_base64url(std::string_view bytes);

}  // namespace lastflat::api
