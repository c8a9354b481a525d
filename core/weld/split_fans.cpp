#include "core/weld/split_fans.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "core/numerics/disjoint_sets.h"
#include "core/weld/sides.h"

namespace lastflat {
namespace {

using SideRange = std::pair<std::vector<Side>::const_iterator, std::vector<Side>::const_iterator>;

Index corner_at(const Side& side, Index vertex) {
    const Index corner = side.from() == vertex ? side.corner : (side.corner + 1) % 3;
    return 3 * side.triangle + corner;
}

void join_across(const Side& a, const Side& b, DisjointSets& fans) {
    fans.join(corner_at(a, a.low), corner_at(b, a.low));
    fans.join(corner_at(a, a.high), corner_at(b, a.high));
}

/// The sides of an edge in the order of their faces' angles around it.
std::vector<Side> around_edge(const Faces& faces, const SideRange& range) {
    const Side& first = *range.first;
    const Vec3 low = faces.position(first.low);
    const Vec3 axis = (faces.position(first.high) - low).normalized();
    const auto outward = [&](const Side& side) -> Vec3 {
        const Triangle& t = faces.triangles[at(side.triangle)];
        const Vec3 arm = faces.position(t[at((side.corner + 2) % 3)]) - low;
        return arm - axis.dot(arm) * axis;
    };
    const Vec3 x = outward(first).normalized(), y = axis.cross(x);
    std::vector<std::tuple<double, bool, Side>> by_angle;
    for (auto side = range.first; side != range.second; ++side) {
        const Vec3 arm = outward(*side);
        by_angle.emplace_back(std::atan2(y.dot(arm), x.dot(arm)), side->forward, *side);
    }
    std::stable_sort(by_angle.begin(), by_angle.end(), [](const auto& a, const auto& b) {
        return std::tie(std::get<0>(a), std::get<1>(a)) < std::tie(std::get<0>(b), std::get<1>(b));
    });
    std::vector<Side> sides;
    sides.reserve(by_angle.size());
    for (const auto& [angle, forward, side] : by_angle) sides.push_back(side);
    return sides;
}

/// Nobody can tell which of several patches is the fin.
void join_all(const SideRange& range, DisjointSets& fans) {
    for (auto side = range.first + 1; side != range.second; ++side)
        join_across(*range.first, *side, fans);
}

/// Which faces of an edge belong together.
enum class Partners { that_bound_material, others };

/// Material lies on the rising side of a face that runs backward along the edge, and ends at the
/// next one that runs forward.
void join_around(std::vector<Side> sides, Partners partners, DisjointSets& fans) {
    std::vector<Side> begins, ends;
    for (bool found = true; found && sides.size() > 1;) {
        found = false;
        for (std::size_t i = 0; i < sides.size() && !found; ++i) {
            const std::size_t next = (i + 1) % sides.size();
            if (sides[i].forward || !sides[next].forward) continue;
            begins.push_back(sides[i]);
            ends.push_back(sides[next]);
            sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(std::max(i, next)));
            sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(std::min(i, next)));
            found = true;
        }
    }
    if (partners == Partners::others && !ends.empty())
        std::rotate(ends.begin(), ends.begin() + 1, ends.end());
    for (std::size_t i = 0; i < begins.size(); ++i) join_across(begins[i], ends[i], fans);
}

/// Joins the corners of faces that hang together over an edge. Returns whether an edge has more
/// than two faces.
bool join_fans(const Faces& faces, Partners partners, DisjointSets& fans) {
    const auto& sides = faces.sides();
    std::optional<DisjointSets> patches;
    for_each_edge(sides, [&](auto first, auto last) {
        if (last - first == 2 && first->forward != (first + 1)->forward)
            join_across(*first, *(first + 1), fans);
        if (last - first <= 2) return;
        if (!patches) patches = patches_of(faces.triangles, sides);
        const SideRange range{first, last};
        const bool one_patch = std::all_of(first, last, [&](const Side& side) {
            return patches->find(side.triangle) == patches->find(first->triangle);
        });
        if ((last - first) % 2 == 1 && !one_patch) return join_all(range, fans);
        join_around(around_edge(faces, range), partners, fans);
    });
    return patches.has_value();
}

/// A corner, its vertex, and the fan that it is in.
struct FanCorner {
    Index vertex, fan, corner;
};

/// Of the vertices that have several fans.
std::vector<FanCorner> corners_by_fan(const Faces& faces, DisjointSets& fans) {
    constexpr Index none = -1, several = -2;
    std::vector<Index> fan_of(faces.positions.size(), none);
    const auto for_each_corner = [&](const auto& visit) {
        for (std::size_t t = 0; t < faces.triangles.size(); ++t) {
            for (std::size_t i = 0; i < 3; ++i)
                visit(faces.triangles[t][i], static_cast<Index>(3 * t + i));
        }
    };
    for_each_corner([&](Index vertex, Index corner) {
        Index& fan = fan_of[at(vertex)];
        const Index own = fans.find(corner);
        fan = fan == none || fan == own ? own : several;
    });
    std::vector<FanCorner> corners;
    for_each_corner([&](Index vertex, Index corner) {
        if (fan_of[at(vertex)] == several) corners.push_back({vertex, fans.find(corner), corner});
    });
    std::sort(corners.begin(), corners.end(), [](const FanCorner& a, const FanCorner& b) {
        return std::tie(a.vertex, a.fan, a.corner) < std::tie(b.vertex, b.fan, b.corner);
    });
    return corners;
}

/// A copy of a vertex for the corners of one fan.
template <class Corners>
void give_copy(Faces& faces, Index vertex, const Corners& first, const Corners& last) {
    const auto copy = static_cast<Index>(faces.positions.size());
    faces.positions.push_back(Vec3(faces.position(vertex)));
    faces.welded_to.push_back(copy);
    const auto files = static_cast<Index>(faces.welded_to.size() - faces.copies.size()) - 1;
    faces.copies.push_back(vertex < files ? vertex : faces.copies[at(vertex - files)]);
    for (auto corner = first; corner != last; ++corner)
        faces.triangles[at(corner->corner / 3)][at(corner->corner % 3)] = copy;
}

/// Returns whether an edge had more than two faces.
bool split(Faces& faces, Partners partners) {
    DisjointSets fans(3 * faces.triangles.size());
    const bool was_crowded = join_fans(faces, partners, fans);
    const auto corners = corners_by_fan(faces, fans);
    for (auto first = corners.begin(); first != corners.end();) {
        const Index vertex = first->vertex;
        auto largest = first, largest_end = first;
        auto last = first;
        for (auto fan = first; fan != corners.end() && fan->vertex == vertex; fan = last) {
            last = std::find_if(fan, corners.end(), [&](const FanCorner& c) {
                return c.vertex != vertex || c.fan != fan->fan;
            });
            if (last - fan <= largest_end - largest) continue;
            largest = fan;
            largest_end = last;
        }
        for (auto fan = first; fan != last;) {
            const auto end =
                std::find_if(fan, last, [&](const FanCorner& c) { return c.fan != fan->fan; });
            if (fan != largest) give_copy(faces, vertex, fan, end);
            fan = end;
        }
        first = last;
    }
    return was_crowded;
}

bool has_crowded_edge(const Faces& faces) {
    bool crowded = false;
    for_each_edge(faces.sides(),
                  [&](auto first, auto last) { crowded = crowded || last - first > 2; });
    return crowded;
}

}  // namespace

void split_fans(Faces& faces) {
    const bool was_crowded = split(faces, Partners::that_bound_material);
    if (was_crowded && has_crowded_edge(faces)) (void)split(faces, Partners::others);
}

void list_split_vertices(const Faces& faces, std::vector<Repair>& repairs) {
    std::vector<bool> used(faces.positions.size(), false);
    for (const Triangle& t : faces.triangles) {
        for (const Index v : t) used[at(v)] = true;
    }
    const std::size_t files = faces.positions.size() - faces.copies.size();
    RepairNote note;
    for (std::size_t k = 0; k < faces.copies.size(); ++k) {
        const Index origin = faces.welded_to[at(faces.copies[k])];
        if (used[files + k] && used[at(origin)] && at(origin) != files + k)
            note.at(faces.positions[files + k]);
    }
    note.write(repairs, "vertices_split",
               "vertices where the surface touched itself became one for each of its parts");
}

}  // namespace lastflat
