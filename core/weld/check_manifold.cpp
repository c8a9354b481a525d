#include "core/weld/check_manifold.h"

#include "core/error.h"
#include "core/numerics/disjoint_sets.h"

namespace lastflat {
namespace {

[[noreturn]] void fail(ErrorCode code, const std::string& what, const Vec3& position) {
    throw Error(code, what + " at " + position_text(position)).at_position(position);
}

Index corner_id(const Side& side, Index offset) {
    return 3 * side.triangle + (side.corner + offset) % 3;
}

/// Joins the corners that two neighbouring triangles have at both ends of their common edge.
void join_corners(DisjointSets& fans, const Side& a, const Side& b) {
    fans.join(corner_id(a, 0), corner_id(b, 1));
    fans.join(corner_id(a, 1), corner_id(b, 0));
}

void check_fans(const Points3& positions, const std::vector<Triangle>& triangles,
                DisjointSets& fans) {
    std::vector<Index> fan_of(positions.size(), -1);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto vertex = static_cast<std::size_t>(triangles[t][i]);
            const Index fan = fans.find(static_cast<Index>(3 * t + i));
            if (fan_of[vertex] == -1) fan_of[vertex] = fan;
            if (fan_of[vertex] == fan) continue;
            fail(ErrorCode::mesh_not_manifold,
                 "vertex " + std::to_string(vertex) +
                     " joins parts of the surface that share nothing else,",
                 positions[vertex]);
        }
    }
}

}  // namespace

void check_manifold(const Points3& positions, const std::vector<Triangle>& triangles,
                    const std::vector<Side>& sides) {
    DisjointSets fans(3 * triangles.size());
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].same_edge(sides[i])) ++end;
        const Vec3 middle = 0.5 * (positions[static_cast<std::size_t>(sides[i].low)] +
                                   positions[static_cast<std::size_t>(sides[i].high)]);
        if (end - i > 2) {
            fail(ErrorCode::mesh_not_manifold,
                 "edge shared by " + std::to_string(end - i) + " faces", middle);
        }
        if (end - i == 2) {
            if (sides[i].forward == sides[i + 1].forward) {
                fail(ErrorCode::mesh_not_oriented,
                     "two faces that share an edge wind in opposite directions", middle);
            }
            join_corners(fans, sides[i], sides[i + 1]);
        }
        i = end;
    }
    check_fans(positions, triangles, fans);
}

bool is_closed(const std::vector<Side>& sides) {
    if (sides.size() % 2 != 0) return false;
    for (std::size_t i = 0; i < sides.size(); i += 2) {
        if (!sides[i].same_edge(sides[i + 1]) || sides[i].forward == sides[i + 1].forward)
            return false;
        if (i + 2 < sides.size() && sides[i].same_edge(sides[i + 2])) return false;
    }
    return true;
}

}  // namespace lastflat
