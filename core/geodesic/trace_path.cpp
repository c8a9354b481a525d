#include "core/geodesic/trace_path.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/geometry.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

using Arrival = GeodesicDistances::Arrival;

/// A straight line on its way back to its root, where it leaves a triangle through the half-edge
/// `exit`: at x in the frame of the neighbour's half-edge there, in which `root` lies above the
/// edge or beyond.
struct Line {
    Index exit;
    double x;
    Vec2 root;
};

/// Whether the line's root is the third corner of the triangle it has just entered.
bool ends_at_apex(const Unfolding& unfolding, const Line& line, Index root) {
    const Index h = unfolding.twin(line.exit);
    return unfolding.apex(h) == root && (unfolding.apex_position(h) - line.root).norm() <
                                            tolerance::geodesic_corner * unfolding.length(h);
}

/// Where the line leaves the triangle that it entered.
Line crossed(const Unfolding& unfolding, const Line& line) {
    const Index h = unfolding.twin(line.exit);
    const Vec2& apex = unfolding.apex_position(h);
    const Vec2 entry(line.x, 0.0), direction = line.root - entry;
    const bool left = cross(apex - entry, direction) > 0.0;
    const Index exit = left ? HalfEdges::previous(h) : HalfEdges::next(h);
    const Vec2 origin = left ? Vec2::Zero() : apex;
    const Vec2 end = left ? apex : Vec2(unfolding.length(h), 0.0);
    const Vec2 along = (end - origin) / unfolding.length(exit);
    const double sine = cross(direction, along);
    const double x = sine != 0.0 ? cross(direction, entry - origin) / sine : 0.0;
    return {exit,
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
    Line line{arrival.half_edge,
              std::clamp(length - x, 0.0, length),
              {length - arrival.position.x(), depth}};
    for (Index step = 0; step < unfolding.count(); ++step) {
        const Index from = unfolding.to(line.exit), to = unfolding.from(line.exit);
        const double share = line.x / unfolding.length(line.exit);
        if (share < tolerance::geodesic_slack) return pass_over(from);
        if (share > 1.0 - tolerance::geodesic_slack) return pass_over(to);
        if (unfolding.twin(line.exit) < 0) lose_way();
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
