// What is to be mapped between a last and its flat pieces, and where it lies there.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/numerics/types.h"

namespace lastflat::api {

template <class Point>
struct Drawing {
    std::string region;  ///< empty: whichever is nearest
    std::vector<Point> points;
    std::vector<std::vector<Point>> polylines;
};

struct MapRequest {
    std::optional<Drawing<Vec3>> to_pattern;
    std::optional<Drawing<Vec2>> to_last;  ///< with a region
};

/// How many points one request may name, those of polylines included.
inline constexpr std::size_t most_mapped_points = 100'000;

/// Reads {"to_pattern": {"region"?, "points"?, "polylines"?}, "to_last": {...}}, one of both at
/// least.
/// Throws: InvalidRequest naming the field.
[[nodiscard]] MapRequest map_request_from_json(std::string_view text);

struct PointOnPattern {
    std::string region;
    Vec2 uv_mm;
    double distance_mm;
};
/// The part of a line that lies in one region.
struct RunOnPattern {
    std::string region;
    Points2 uv_mm;
    double distance_mm;  ///< the greatest
};
struct PointOnLast {
    Vec3 position;
    double distance_mm;
};
struct LineOnLast {
    Points3 positions;
    double distance_mm = 0.0;  ///< the greatest
};

struct Mapped {
    struct ToPattern {
        std::vector<PointOnPattern> points;
        std::vector<std::vector<RunOnPattern>> polylines;
    };
    struct ToLast {
        std::vector<PointOnLast> points;
        std::vector<LineOnLast> polylines;
    };
    std::optional<ToPattern> to_pattern;
    std::optional<ToLast> to_last;
};
/// `indent`: for people; -1: none.
[[nodiscard]] std::string to_json(const Mapped& mapped, int indent = -1);

}  // namespace lastflat::api
