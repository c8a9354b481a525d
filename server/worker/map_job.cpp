#include "server/worker/map_job.h"

#include <algorithm>
#include <cmath>

#include "api/map_request.h"
#include "api/problem_json.h"
#include "core/map/pattern_map.h"
#include "server/worker/problem_map.h"

namespace lastflat::server {
namespace {

using Json = nlohmann::ordered_json;

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

template <class Point, class Wire>
std::vector<Point> points_of(const std::vector<Wire>& wire) {
    std::vector<Point> points;
    points.reserve(wire.size());
    for (const Wire& p : wire) points.push_back(Eigen::Map<const Point>(p.data()));
    return points;
}

Json pair(const Vec2& p) {
    return {p.x(), p.y()};
}
Json triple(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}

Json to_pattern(const PatternMap& map, const api::Drawing<3>& drawing) {
    const auto region =
        drawing.region.empty() ? std::nullopt : std::optional<std::string>(drawing.region);
    Json points = Json::array(), lines = Json::array();
    for (const Vec3& point : points_of<Vec3>(drawing.points)) {
        const auto at = map.to_pattern(point, region);
        points.push_back(
            {{"region", at.piece}, {"uv_mm", pair(at.uv)}, {"distance_mm", at.distance}});
    }
    std::size_t left = most_steps;
    for (const auto& polyline : drawing.polylines) {
        // A line over a cut goes on in another piece.
        Json runs = Json::array();
        walk(points_of<Vec3>(polyline), left, [&](const Vec3& point) {
            const auto at = map.to_pattern(point, region);
            if (runs.empty() || runs.back()["region"] != at.piece)
                runs.push_back(
                    {{"region", at.piece}, {"uv_mm", Json::array()}, {"distance_mm", 0.0}});
            Json& run = runs.back();
            run["uv_mm"].push_back(pair(at.uv));
            run["distance_mm"] = std::max(run["distance_mm"].get<double>(), at.distance);
        });
        lines.push_back(std::move(runs));
    }
    return {{"points", std::move(points)}, {"polylines", std::move(lines)}};
}

Json to_last(const PatternMap& map, const api::Drawing<2>& drawing) {
    Json points = Json::array(), lines = Json::array();
    for (const Vec2& point : points_of<Vec2>(drawing.points)) {
        const auto at = map.to_last(drawing.region, point);
        points.push_back({{"position", triple(at.position)}, {"distance_mm", at.distance}});
    }
    std::size_t left = most_steps;
    for (const auto& polyline : drawing.polylines) {
        Json positions = Json::array();
        double furthest = 0.0;
        walk(points_of<Vec2>(polyline), left, [&](const Vec2& point) {
            const auto at = map.to_last(drawing.region, point);
            positions.push_back(triple(at.position));
            furthest = std::max(furthest, at.distance);
        });
        lines.push_back({{"positions", std::move(positions)}, {"distance_mm", furthest}});
    }
    return {{"points", std::move(points)}, {"polylines", std::move(lines)}};
}

Json mapped(const std::string& flat_obj, const std::string& text) {
    const api::MapRequest request = api::map_request_from_json(text);
    const PatternMap map(read_flat_obj(flat_obj));
    Json report = Json::object();
    try {
        if (request.to_pattern) report["to_pattern"] = to_pattern(map, *request.to_pattern);
    } catch (Error& error) {
        throw error.at_option({"to_pattern", "region"});
    }
    try {
        if (request.to_last) report["to_last"] = to_last(map, *request.to_last);
    } catch (Error& error) {
        throw error.at_option({"to_last", "region"});
    }
    return report;
}

}  // namespace

Json map_job(const std::string& flat_obj, const std::string& request) {
    try {
        return {{"report", mapped(flat_obj, request)}};
    } catch (const api::InvalidRequest& error) {
        return {{"problem", api::problem_json(problem_of(error))}};
    } catch (const Error& error) {
        return {{"problem", api::problem_json(problem_of(error))}};
    } catch (const std::bad_alloc&) {
        return {{"problem", api::problem_json(out_of_memory())}};
    }
}

}  // namespace lastflat::server
