// Times on the wire: RFC 3339 in UTC, to the millisecond.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace lastflat::api {

/// "2024-02-29T23:59:59.123Z". In: milliseconds since 1970.
[[nodiscard]] std::string rfc3339(std::int64_t milliseconds);

/// The inverse, for whole seconds or fractions of them, in UTC; nothing if it is no such time.
[[nodiscard]] std::optional<std::int64_t> rfc3339_ms(const std::string& text);

}  // namespace lastflat::api
