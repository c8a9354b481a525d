#include "core/cut/one_rings.h"

#include <algorithm>

namespace lastflat {

OneRings::OneRings(const Region& region) : on_border_(border_mask(region)) {
    // At each vertex, the sides that face it, sorted by where they begin, form the ring's links.
    struct Link {
        Index vertex, from, to;
    };
    std::vector<Link> links;
    links.reserve(3 * region.triangles.size());
    for (const Triangle& t : region.triangles) {
        for (std::size_t i = 0; i < 3; ++i) links.push_back({t[i], t[(i + 1) % 3], t[(i + 2) % 3]});
    }
    const auto before = [](const Link& a, const Link& b) {
        return a.vertex != b.vertex ? a.vertex < b.vertex : a.from < b.from;
    };
    std::sort(links.begin(), links.end(), before);

    std::vector<Index> first(region.positions.size(), -1);
    for (const auto& loop : border_loops(region)) {
        for (std::size_t i = 0; i < loop.size(); ++i)
            first[static_cast<std::size_t>(loop[i])] = loop[(i + 1) % loop.size()];
    }
    begin_.push_back(0);
    auto link = links.begin();
    for (Index v = 0; v < static_cast<Index>(region.positions.size()); ++v) {
        const auto begin = link;
        while (link != links.end() && link->vertex == v) ++link;
        if (begin != link) {
            Index at = first[static_cast<std::size_t>(v)];
            if (at < 0) at = begin->from;
            const auto degree = static_cast<std::size_t>(link - begin);
            for (std::size_t k = 0; k < degree; ++k) {
                neighbours_.push_back(at);
                at = std::lower_bound(begin, link, Link{v, at, 0}, before)->to;
            }
            if (on_border_[static_cast<std::size_t>(v)]) neighbours_.push_back(at);
        }
        begin_.push_back(neighbours_.size());
    }
}

EliminationOrder elimination_order(const OneRings& rings) {
    const Index n = rings.vertex_count();
    SparseMatrix pattern(n, n);
    pattern.reserve(static_cast<Eigen::Index>(7) * n);
    std::vector<Index> column;
    for (Index v = 0; v < n; ++v) {
        const auto ring = rings.of(v);
        column.assign(ring.begin(), ring.end());
        column.push_back(v);
        std::sort(column.begin(), column.end());
        pattern.startVec(v);
        for (const Index w : column) pattern.insertBackByOuterInner(v, w) = 1.0;
    }
    pattern.finalize();
    return elimination_order(pattern);
}

}  // namespace lastflat
