#include "core/weld/joined_seams.h"

#include <map>

#include "core/numerics/disjoint_sets.h"
#include "core/weld/sides.h"

namespace lastflat {
namespace {

struct JoinedSlit {
    Points3 middles;  ///< of its edges
    double length = 0.0;
};

/// Per triangle and corner, whether the side that begins there was on the border.
std::vector<bool> border_sides(const std::vector<Triangle>& triangles) {
    std::vector<bool> border(3 * triangles.size(), false);
    for_each_edge(sides_by_edge(triangles), [&](auto first, auto last) {
        if (last - first == 1) border[at(3 * first->triangle + first->corner)] = true;
    });
    return border;
}

}  // namespace

void list_joined_seams(const std::vector<Triangle>& before, const Faces& faces,
                       std::vector<Repair>& repairs) {
    const auto border = border_sides(before);
    std::vector<Side> joined;
    DisjointSets sets(faces.positions.size());
    for_each_edge(faces.sides(), [&](auto first, auto last) {
        if (last - first < 2 || !border[at(3 * first->triangle + first->corner)]) return;
        if (first->low == first->high) return;
        joined.push_back(*first);
        sets.join(first->low, first->high);
    });
    std::map<Index, JoinedSlit> seams;
    for (const Side& side : joined) {
        JoinedSlit& seam = seams[sets.find(side.low)];
        const Vec3 &a = faces.position(side.low), &b = faces.position(side.high);
        seam.middles.push_back(0.5 * (a + b));
        seam.length += (b - a).norm();
    }
    if (seams.empty()) return;
    Repair repair{"seams_joined",
                  std::to_string(seams.size()) +
                      " slits between vertices in one position were joined; they stay with "
                      "\"weld\": {\"coincident\": \"keep\"}",
                  seams.size()};
    for (const auto& [root, seam] : seams) {
        if (repair.positions.size() == Repair::most_listed) break;
        repair.positions.push_back(seam.middles[seam.middles.size() / 2]);
        repair.lengths_mm.push_back(seam.length);
    }
    repairs.push_back(std::move(repair));
}

}  // namespace lastflat
