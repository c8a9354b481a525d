#include "core/locate/group_line.h"

#include <algorithm>
#include <map>
#include <set>

#include "core/locate/curve_error.h"

namespace lastflat {
namespace {

using Edge = std::pair<Index, Index>;

[[noreturn]] void fail_border_of(const std::string& curve, const std::string& what,
                                 const std::optional<Vec3>& position = std::nullopt) {
    fail_curve(curve, "border_of", std::nullopt, what, position);
}

/// Per label set, whether it has the group's name.
std::vector<bool> labels_of(const SurfaceMesh& surface, const std::string& curve,
                            const GroupBorder& border, std::size_t item) {
    const std::string& group = border.groups[item];
    std::vector<bool> has;
    for (const auto& names : surface.label_sets) {
        has.push_back(contains(names, group));
    }
    if (!contains(has, true)) {
        throw Error(ErrorCode::group_not_found,
                    "curve '" + curve + "': the model has no group '" + group + "'")
            .at_option({"curves", curve, "border_of", "groups", std::to_string(item)});
    }
    return has;
}

std::vector<Edge> edges_between(const SurfaceMesh& surface, const std::string& curve,
                                const GroupBorder& border) {
    const std::vector<bool> first = labels_of(surface, curve, border, 0);
    std::vector<bool> second(first.size());
    if (border.groups.size() > 1)
        second = labels_of(surface, curve, border, 1);
    else
        std::transform(first.begin(), first.end(), second.begin(), [](bool b) { return !b; });
    const auto is = [](const std::vector<bool>& has, std::optional<std::uint32_t> label) {
        return label && has[*label];
    };
    const bool alone = border.groups.size() == 1;
    std::vector<Edge> edges;
    for (const auto edge : surface.mesh.edges()) {
        const auto h = surface.mesh.halfedge_handle(edge, 0);
        const auto a = surface.label_at(h),
                   b = surface.label_at(surface.mesh.opposite_halfedge_handle(h));
        const bool meet = (is(first, a) && (is(second, b) || (alone && !b))) ||
                          (is(first, b) && (is(second, a) || (alone && !a)));
        if (meet)
            edges.emplace_back(surface.mesh.from_vertex_handle(h).idx(),
                               surface.mesh.to_vertex_handle(h).idx());
    }
    return edges;
}

}  // namespace

std::vector<Index> group_line(const SurfaceMesh& surface, const std::string& curve,
                              const GroupBorder& border) {
    std::map<Index, std::vector<Index>> neighbours;
    for (const auto& [a, b] : edges_between(surface, curve, border)) {
        neighbours[a].push_back(b);
        neighbours[b].push_back(a);
    }
    if (neighbours.empty()) fail_border_of(curve, "the groups do not meet along any edge");
    Index begin = neighbours.begin()->first;
    for (auto& [vertex, next] : neighbours) {
        std::sort(next.begin(), next.end());
        if (next.size() > 2)
            fail_border_of(curve,
                           "the line between the groups branches at " +
                               position_text(surface.position(vertex)),
                           surface.position(vertex));
        if (next.size() == 1 && neighbours.at(begin).size() != 1) begin = vertex;
    }
    std::vector<Index> line{begin};
    std::set<Index> seen{begin};
    for (Index at = begin;;) {
        const auto& next = neighbours.at(at);
        const auto further =
            std::find_if(next.begin(), next.end(), [&](Index v) { return !seen.contains(v); });
        if (further == next.end()) break;
        at = *further;
        seen.insert(at);
        line.push_back(at);
    }
    if (neighbours.at(begin).size() == 2) line.push_back(begin);
    if (seen.size() < neighbours.size()) {
        const auto other = std::find_if(neighbours.begin(), neighbours.end(),
                                        [&](const auto& n) { return !seen.contains(n.first); });
        fail_border_of(curve,
                       "the groups meet along more than one line; another is at " +
                           position_text(surface.position(other->first)),
                       surface.position(other->first));
    }
    return line;
}

}  // namespace lastflat
