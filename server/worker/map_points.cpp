#include "server/worker/map_points.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace lastflat::server {
namespace {

constexpr double step_mm = 1.0;
constexpr std::size_t most_steps = 1'000'000;  ///< of all lines of a request

/// Calls visit(point) for the corners of a line and for points between them, a step apart.
template <class Point, class Visit>
void walk(const std::vector<Point>& corners, std::size_t& left, const Visit& visit) {
    visit(corners.front());
    for (std::size_t i = 1; i < corners.size(); ++i) {
        const Point way = corners[i] - corners[i - 1];
        const auto steps = static_cast<std::size_t>(std::ceil(way.norm() / step_mm));
        const std::size_t taken = std::clamp<std::size_t>(steps, 1, std::max<std::size_t>(left, 1));
        left -= std::min(left, taken);
        for (std::size_t k = 1; k < taken; ++k)
            visit(
                Point(corners[i - 1] + static_cast<double>(k) / static_cast<double>(taken) * way));
        visit(corners[i]);
    }
}

api::Mapped::ToPattern to_pattern(const PatternMap& map, const api::Drawing<Vec3>& drawing) {
    const auto region =
        drawing.region.empty() ? std::nullopt : std::optional<std::string>(drawing.region);
    api::Mapped::ToPattern mapped;
    for (const Vec3& point : drawing.points) {
        const auto at = map.to_pattern(point, region);
        mapped.points.push_back({at.piece, at.uv, at.distance});
    }
    std::size_t left = most_steps;
    for (const Points3& polyline : drawing.polylines) {
        // A line over a cut goes on in another piece.
        auto& runs = mapped.polylines.emplace_back();
        walk(polyline, left, [&](const Vec3& point) {
            const auto at = map.to_pattern(point, region);
            if (runs.empty() || runs.back().region != at.piece) runs.push_back({at.piece, {}, 0.0});
            runs.back().uv_mm.push_back(at.uv);
            runs.back().distance_mm = std::max(runs.back().distance_mm, at.distance);
        });
    }
    return mapped;
}

api::Mapped::ToLast to_last(PatternMap& map, const api::Drawing<Vec2>& drawing) {
    api::Mapped::ToLast mapped;
    for (const Vec2& point : drawing.points) {
        const auto at = map.to_last(drawing.region, point);
        mapped.points.push_back({at.position, at.distance});
    }
    std::size_t left = most_steps;
    for (const Points2& polyline : drawing.polylines) {
        api::LineOnLast& line = mapped.polylines.emplace_back();
        walk(polyline, left, [&](const Vec2& point) {
            const auto at = map.to_last(drawing.region, point);
            line.positions.push_back(at.position);
            line.distance_mm = std::max(line.distance_mm, at.distance);
        });
    }
    return mapped;
}

/// An error names the drawing whose region it is about.
template <class Map>
auto named(const char* drawing, const Map& map) {
    try {
        return map();
    } catch (Error& error) {
        throw error.at_option({drawing, "region"});
    }
}

}  // namespace

api::Mapped mapped(PatternMap& map, const api::MapRequest& request) {
    api::Mapped found;
    if (request.to_pattern)
        found.to_pattern =
            named("to_pattern", [&] { return to_pattern(map, *request.to_pattern); });
    if (request.to_last)
        found.to_last = named("to_last", [&] { return to_last(map, *request.to_last); });
    return found;
}

}  // namespace lastflat::server
