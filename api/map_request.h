// What is to be mapped between a last and its flat pieces, as it stands on the wire.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lastflat::api {

template <std::size_t dimensions>
struct Drawing {
    std::string region;  ///< empty: whichever is nearest
    std::vector<std::array<double, dimensions>> points;
    std::vector<std::vector<std::array<double, dimensions>>> polylines;
};

struct MapRequest {
    std::optional<Drawing<3>> to_pattern;
    std::optional<Drawing<2>> to_last;  ///< with a region
};

/// How many points one request may name, those of polylines included.
inline constexpr std::size_t most_mapped_points = 100'000;

/// Reads {"to_pattern": {"region"?, "points"?, "polylines"?}, "to_last": {...}}, one of both at
/// least.
/// Throws: InvalidRequest naming the field.
[[nodiscard]] MapRequest map_request_from_json(std::string_view text);

}  // namespace lastflat::api
