#include "core/weld/fins.h"

#include <algorithm>
#include <map>
#include <set>

#include "core/numerics/geometry.h"
#include "core/numerics/tolerances.h"
#include "core/weld/sides.h"

namespace lastflat {
namespace {

template <class Sides>
int excess(const Sides& first, const Sides& last) {
    int forward = 0;
    for (auto side = first; side != last; ++side) forward += side->forward ? 1 : -1;
    return forward;
}

}  // namespace

void drop_fins(Faces& faces, std::vector<Repair>& repairs) {
    const auto& sides = faces.sides();
    DisjointSets patches = patches_of(faces.triangles, sides);
    std::map<Index, double> areas;
    double largest = 0.0;
    for (std::size_t t = 0; t < faces.triangles.size(); ++t) {
        double& area = areas[patches.find(static_cast<Index>(t))];
        area += doubled_area_vector(faces, faces.triangles[t]).norm();
        largest = std::max(largest, area);
    }
    std::set<Index> open, too_many;
    for_each_edge(sides, [&](auto first, auto last) {
        if (last - first == 1) open.insert(patches.find(first->triangle));
        if (last - first < 3 || (last - first) % 2 == 0) return;
        const bool forward = excess(first, last) > 0;
        for (auto side = first; side != last; ++side) {
            const Index patch = patches.find(side->triangle);
            if (side->forward == forward && areas[patch] < tolerance::stray_area * largest)
                too_many.insert(patch);
        }
    });
    RepairNote note;
    std::vector<Triangle> kept;
    std::vector<FaceOrigin> origins;
    for (std::size_t t = 0; t < faces.triangles.size(); ++t) {
        const Index patch = patches.find(static_cast<Index>(t));
        if (open.contains(patch) && too_many.contains(patch)) {
            note.at(faces.position(faces.triangles[t][0]));
            continue;
        }
        kept.push_back(faces.triangles[t]);
        origins.push_back(faces.origins[t]);
    }
    if (note.count() == 0) return;
    faces.triangles = std::move(kept);
    faces.origins = std::move(origins);
    note.write(repairs, "fins_dropped",
               "triangles that stood on edges of two others were left out");
}

std::optional<Error> edge_to_part(const Faces& faces) {
    std::optional<Error> found;
    for_each_edge(faces.sides(), [&](auto first, auto last) {
        const auto count = last - first;
        const bool clash = count == 2 && excess(first, last) != 0;
        if (found || (!clash && (count < 3 || count % 2 == 0))) return;
        const Vec3 middle = 0.5 * (faces.position(first->low) + faces.position(first->high));
        const std::string place = " at " + position_text(middle);
        found = clash ? Error(ErrorCode::mesh_not_oriented,
                              "two faces that share an edge wind in opposite directions" + place)
                      : Error(ErrorCode::mesh_not_manifold,
                              "edge shared by " + std::to_string(count) + " faces" + place);
        found->at_position(middle);
    });
    return found;
}

}  // namespace lastflat
