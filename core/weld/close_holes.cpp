#include "core/weld/close_holes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>

#include "core/numerics/least_area.h"
#include "core/numerics/tolerances.h"
#include "core/weld/borders.h"
#include "core/weld/sides.h"

namespace lastflat {
namespace {

/// The triangulation takes the cube of a loop's vertices.
constexpr std::size_t most_vertices = 512;

double across(const Faces& faces, const Loop& loop) {
    double widest = 0.0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j)
            widest = std::max(
                widest, (faces.position(loop.vertex(i)) - faces.position(loop.vertex(j))).norm());
    }
    return widest;
}

/// Holes that meet in a vertex came as one loop with a copy of it: each becomes a loop of its own.
std::vector<Loop> simple_loops(Faces& faces) {
    const std::size_t files = faces.positions.size() - faces.copies.size();
    const auto origin = [&](Index v) {
        return at(v) < files ? v : faces.welded_to[at(faces.copies[at(v) - files])];
    };
    std::map<Index, Index> rejoined;
    std::vector<std::vector<Index>> simple;
    for (const Loop& loop : border_loops(faces)) {
        std::vector<Index> open;
        for (const Index v : loop.vertices) {
            const auto met = std::find_if(open.begin(), open.end(),
                                          [&](Index w) { return origin(w) == origin(v); });
            if (met != open.end()) {
                rejoined[v] = *met;
                simple.emplace_back(met, open.end());
                open.erase(met + 1, open.end());
            } else {
                open.push_back(v);
            }
        }
        simple.push_back(std::move(open));
    }
    if (rejoined.empty()) return border_loops(faces);
    rename_vertices(faces, rejoined);
    std::vector<Loop> loops;
    for (auto& vertices : simple) {
        if (vertices.size() > 2)  // else its two edges are one now
            loops.push_back(loop_of(faces, std::move(vertices)));
    }
    return loops;
}

Vec3 middle_of(const Faces& faces, const Loop& loop) {
    Vec3 sum = Vec3::Zero();
    for (const Index v : loop.vertices) sum += faces.position(v);
    return sum / static_cast<double>(loop.size());
}

/// Of the face beside the loop's first edge.
FaceOrigin origin_beside(const Faces& faces, const Loop& loop) {
    for (std::size_t t = 0; t < faces.triangles.size(); ++t) {
        const Triangle& triangle = faces.triangles[t];
        for (std::size_t i = 0; i < 3; ++i) {
            if (triangle[i] == loop.vertex(0) && triangle[(i + 1) % 3] == loop.vertex(1))
                return faces.origins[t];
        }
    }
    return {0, -1};
}

}  // namespace

bool has_only_small_holes(const Faces& faces) {
    const auto loops = border_loops(faces);
    const double limit = std::min(tolerance::small_hole_mm, tolerance::small_hole * size_of(faces));
    return !loops.empty() && std::all_of(loops.begin(), loops.end(), [&](const Loop& loop) {
        return loop.size() <= most_vertices && across(faces, loop) <= limit;
    });
}

void close_small_holes(Faces& faces, std::vector<Repair>& repairs) {
    if (!has_only_small_holes(faces)) return;
    const auto loops = simple_loops(faces);
    std::set<std::pair<Index, Index>> edges;
    for (const Side& side : faces.sides()) edges.emplace(side.low, side.high);
    Repair repair{"holes_closed", "", loops.size()};
    for (const Loop& loop : loops) {
        const FaceOrigin origin = origin_beside(faces, loop).filling_beside();
        Points3 corners;
        for (const Index v : loop.vertices) corners.push_back(faces.position(v));
        const auto filling = least_area_triangles(corners, [&](std::size_t i, std::size_t j) {
            return edges.contains(std::minmax(loop.vertices[i], loop.vertices[j]));
        });
        for (const Triangle& t : filling) {
            faces.triangles.push_back(
                {loop.vertices[at(t[0])], loop.vertices[at(t[2])], loop.vertices[at(t[1])]});
            faces.origins.push_back(origin);
        }
        if (repair.positions.size() == Repair::most_listed) continue;
        repair.positions.push_back(middle_of(faces, loop));
        repair.lengths_mm.push_back(loop.length);
    }
    repair.detail =
        std::to_string(loops.size()) +
        " small holes of a closed surface were closed; they stay with \"holes\": \"keep\"";
    repairs.push_back(std::move(repair));
}

}  // namespace lastflat
