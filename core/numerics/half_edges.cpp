#include "core/numerics/half_edges.h"

#include <algorithm>

namespace lastflat {
namespace {

/// The half-edges from every vertex: those of v stand at begin[v] .. begin[v + 1].
struct Fans {
    std::vector<std::size_t> begin;
    std::vector<Index> half_edges;

    [[nodiscard]] std::size_t degree(Index v) const { return begin[at(v) + 1] - begin[at(v)]; }
};

Fans fans_of(const Triangulation& surface) {
    Fans fans;
    fans.begin.assign(surface.positions.size() + 1, 0);
    for (const Triangle& t : surface.triangles) {
        for (const Index v : t) ++fans.begin[at(v) + 1];
    }
    for (std::size_t v = 1; v < fans.begin.size(); ++v) fans.begin[v] += fans.begin[v - 1];
    fans.half_edges.resize(fans.begin.back());
    std::vector<std::size_t> end(fans.begin.begin(), fans.begin.end() - 1);
    Index h = 0;
    for (const Triangle& t : surface.triangles) {
        for (const Index v : t) fans.half_edges[end[at(v)]++] = h++;
    }
    return fans;
}

}  // namespace

HalfEdges::HalfEdges(const Triangulation& surface) {
    edges_.reserve(3 * surface.triangles.size());
    for (const Triangle& t : surface.triangles) {
        for (const Index v : t) edges_.push_back({v, -1});
    }
    const Fans fans = fans_of(surface);
    for (Index h = 0; h < count(); ++h) {
        // From the end of higher degree the other's fan is searched: no fan is searched too often.
        const Index a = from(h), b = to(h);
        if (twin(h) >= 0 || fans.degree(b) > fans.degree(a)) continue;
        for (std::size_t k = fans.begin[at(b)]; k < fans.begin[at(b) + 1]; ++k) {
            const Index g = fans.half_edges[k];
            if (to(g) != a) continue;
            edges_[at(h)].twin = g;
            edges_[at(g)].twin = h;
        }
    }
    outgoing_.assign(surface.positions.size(), -1);
    for (Index h = 0; h < count(); ++h) {
        Index& first = outgoing_[at(from(h))];
        if (first < 0 || twin(h) < 0) first = h;
    }
}

std::vector<Index> HalfEdges::ring(Index vertex) const {
    std::vector<Index> ring;
    ring.reserve(8);
    Index last = -1;
    for (const Index h : around(vertex)) {
        ring.push_back(to(h));
        last = h;
    }
    if (on_border(vertex))
        ring.push_back(apex(last));
    else
        std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
    return ring;
}

Index HalfEdges::find(Index from, Index to) const {
    for (const Index h : around(from)) {
        if (this->to(h) == to) return h;
    }
    return -1;
}

std::vector<std::vector<Index>> HalfEdges::border_loops() const {
    std::vector<std::vector<Index>> loops;
    std::vector<bool> seen(outgoing_.size(), false);
    for (Index start = 0; start < vertex_count(); ++start) {
        if (!on_border(start) || seen[at(start)]) continue;
        loops.emplace_back();
        for (Index v = start; !seen[at(v)]; v = to(outgoing(v))) {
            seen[at(v)] = true;
            loops.back().push_back(v);
        }
    }
    return loops;
}

}  // namespace lastflat
