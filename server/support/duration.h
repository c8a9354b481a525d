// Durations as people write them.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace lastflat::server {

/// "90", "90s", "2m", "1h", "7d" in milliseconds; nothing if the text is none of these.
[[nodiscard]] std::optional<std::int64_t> duration_ms(std::string_view text);

}  // namespace lastflat::server
