#include "core/geodesic/half_edges.h"

#include <Eigen/Geometry>
#include <cmath>

namespace lastflat {
namespace {

/// The half-edges from every vertex: those of v stand at begin[v] .. begin[v + 1].
struct Fans {
    std::vector<std::size_t> begin;
    std::vector<Index> half_edges;
};

Fans fans_of(const Triangulation& surface) {
    Fans fans;
    fans.begin.assign(surface.positions.size() + 1, 0);
    for (const Triangle& t : surface.triangles) {
        for (const Index v : t) ++fans.begin[static_cast<std::size_t>(v) + 1];
    }
    for (std::size_t v = 1; v < fans.begin.size(); ++v) fans.begin[v] += fans.begin[v - 1];
    fans.half_edges.resize(fans.begin.back());
    std::vector<std::size_t> end(fans.begin.begin(), fans.begin.end() - 1);
    Index h = 0;
    for (const Triangle& t : surface.triangles) {
        for (const Index v : t) fans.half_edges[end[static_cast<std::size_t>(v)]++] = h++;
    }
    return fans;
}

}  // namespace

HalfEdges::HalfEdges(const Triangulation& surface) {
    edges_.reserve(3 * surface.triangles.size());
    for (const Triangle& t : surface.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3& origin = surface.position(t[i]);
            const Vec3 along = surface.position(t[(i + 1) % 3]) - origin;
            const Vec3 across = surface.position(t[(i + 2) % 3]) - origin;
            const double length = along.norm();
            edges_.push_back({{along.dot(across) / length, along.cross(across).norm() / length},
                              length,
                              t[i],
                              -1});
        }
    }
    const Fans fans = fans_of(surface);
    const auto degree = [&](Index v) {
        return fans.begin[static_cast<std::size_t>(v) + 1] -
               fans.begin[static_cast<std::size_t>(v)];
    };
    for (Index h = 0; h < count(); ++h) {
        // From the end of higher degree the other's fan is searched: no fan is searched too often.
        const Index a = from(h), b = to(h);
        if (edge(h).twin >= 0 || degree(b) > degree(a)) continue;
        for (std::size_t k = fans.begin[static_cast<std::size_t>(b)];
             k < fans.begin[static_cast<std::size_t>(b) + 1]; ++k) {
            const Index g = fans.half_edges[k];
            if (to(g) != a) continue;
            edges_[static_cast<std::size_t>(h)].twin = g;
            edges_[static_cast<std::size_t>(g)].twin = h;
        }
    }
    outgoing_.assign(surface.positions.size(), -1);
    for (Index h = 0; h < count(); ++h) {
        Index& first = outgoing_[static_cast<std::size_t>(from(h))];
        if (first < 0 || twin(h) < 0) first = h;
    }
}

double HalfEdges::angle(Index h) const {
    return std::atan2(apex_place(h).y(), apex_place(h).x());
}

double HalfEdges::total_angle(Index vertex) const {
    const Index first = outgoing(vertex);
    double sum = 0.0;
    for (Index h = first; h >= 0;) {
        sum += angle(h);
        h = rotated(h);
        if (h == first) break;
    }
    return sum;
}

}  // namespace lastflat
