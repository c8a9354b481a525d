#include "core/geodesic/trace_path.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/geometry.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

using Arrival = GeodesicDistances::Arrival;

/// A straight line that crosses half-edge h at x, on its way back to its root, which lies at
/// `root` in the frame of h, above the edge or beyond.
struct Line {
    Index half_edge;
    double x;
    Vec2 root;
};

/// Whether the line's root is the third corner of the triangle it has just entered.
bool ends_at_apex(const Unfolding& unfolding, const Line& line, Index root) {
    return unfolding.apex(line.half_edge) == root &&
           (unfolding.apex_position(line.half_edge) - line.root).norm() <
               tolerance::geodesic_corner * unfolding.length(line.half_edge);
}

/// The edge through which the line leaves the triangle that it entered, seen from the next one.
/// The half-edge is -1 if there is no next one.
Line crossed(const Unfolding& unfolding, const Line& line) {
    const Index h = line.half_edge;
    const Vec2& apex = unfolding.apex_position(h);
    const Vec2 entry(line.x, 0.0), direction = line.root - entry;
    const bool left = cross(apex - entry, direction) > 0.0;
    const Index exit = left ? HalfEdges::previous(h) : HalfEdges::next(h);
    const Vec2 origin = left ? Vec2::Zero() : apex;
    const Vec2 end = left ? apex : Vec2(unfolding.length(h), 0.0);
    const Vec2 along = (end - origin) / unfolding.length(exit);
    const double sine = cross(direction, along);
    const double x = sine != 0.0 ? cross(direction, entry - origin) / sine : 0.0;
    return {unfolding.twin(exit),
            std::clamp(x, 0.0, unfolding.length(exit)),
            {along.dot(line.root - origin), cross(along, line.root - origin)}};
}

/// Appends the straight stretch before `vertex`, from there backwards, and returns where it begins:
/// at its root, or at a vertex that it passes closely. Over that vertex the way is as long, and
/// which side of it the line passes round-off would decide.
Index trace_stretch(const Unfolding& unfolding, const Arrival& arrival, Index vertex,
                    std::vector<PathPoint>& points) {
    const auto lose_way = [&] {
        throw Error(
            ErrorCode::solver_failed,
            "a shortest path to vertex " + std::to_string(vertex) + " cannot be traced back");
    };
    if (arrival.half_edge < 0) return arrival.root;
    const std::size_t begin = points.size();
    // Where the line crosses the vertex's own edges beside it, the way over the vertex has no turn.
    const auto pass_over = [&](Index passed) {
        while (points.size() > begin && (points.back().a == passed || points.back().b == passed))
            points.pop_back();
        return passed;
    };
    // First across the arrival's own edge, seen from the triangle before it.
    const Vec2& apex = unfolding.apex_position(arrival.half_edge);
    const double length = unfolding.length(arrival.half_edge), depth = -arrival.position.y();
    const double x =
        arrival.position.x() + (apex.x() - arrival.position.x()) * depth / (apex.y() + depth);
    Line line{unfolding.twin(arrival.half_edge),
              std::clamp(length - x, 0.0, length),
              {length - arrival.position.x(), depth}};
    for (Index step = 0; step < unfolding.count(); ++step) {
        if (line.half_edge < 0) lose_way();
        const Index from = unfolding.from(line.half_edge), to = unfolding.to(line.half_edge);
        const double share = line.x / unfolding.length(line.half_edge);
        if (share < tolerance::geodesic_slack) return pass_over(from);
        if (share > 1.0 - tolerance::geodesic_slack) return pass_over(to);
        points.push_back({from, to, share});
        if (ends_at_apex(unfolding, line, arrival.root)) return arrival.root;
        line = crossed(unfolding, line);
    }
    lose_way();
    return arrival.root;
}

}  // namespace

GeodesicPath trace_path(const Unfolding& unfolding, const GeodesicDistances& distances,
                        Index vertex) {
    GeodesicPath path;
    for (Index at = vertex; at >= 0;) {
        path.points.push_back({at, at, 0.0});
        if (at == distances.source) break;
        const Arrival& arrival = distances.arrivals[static_cast<std::size_t>(at)];
        at = trace_stretch(unfolding, arrival, at, path.points);
    }
    std::reverse(path.points.begin(), path.points.end());
    return path;
}

}  // namespace lastflat
