#include "core/inspect.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "core/cut/open_holes.h"

namespace lastflat {
namespace {

std::size_t count_components(const TriMesh& mesh) {
    std::vector<bool> seen(mesh.n_faces(), false);
    std::vector<OpenMesh::FaceHandle> stack;
    std::size_t components = 0;
    const auto visit = [&](OpenMesh::FaceHandle face) {
        const auto index = static_cast<std::size_t>(face.idx());
        if (seen[index]) return;
        seen[index] = true;
        stack.push_back(face);
    };
    for (const auto seed : mesh.faces()) {
        if (seen[static_cast<std::size_t>(seed.idx())]) continue;
        ++components;
        visit(seed);
        while (!stack.empty()) {
            const auto face = stack.back();
            stack.pop_back();
            for (const auto neighbour : mesh.ff_range(face)) visit(neighbour);
        }
    }
    return components;
}

std::vector<BorderLoop> border_loops(const TriMesh& mesh) {
    std::vector<bool> seen(mesh.n_halfedges(), false);
    std::vector<BorderLoop> loops;
    for (const auto start : mesh.halfedges()) {
        if (!mesh.is_boundary(start) || seen[static_cast<std::size_t>(start.idx())]) continue;
        double length = 0.0;
        OpenMesh::HalfedgeHandle side = start;
        do {
            seen[static_cast<std::size_t>(side.idx())] = true;
            length += mesh.calc_edge_length(side);
            side = mesh.next_halfedge_handle(side);
        } while (side != start);
        const auto& p = mesh.point(mesh.from_vertex_handle(start));
        loops.push_back({length, {p[0], p[1], p[2]}});
    }
    std::stable_sort(loops.begin(), loops.end(), [](const BorderLoop& a, const BorderLoop& b) {
        return a.length_mm > b.length_mm;
    });
    return loops;
}

void measure_surface(const TriMesh& mesh, Inspection& found) {
    found.triangles = mesh.n_faces();
    found.components = count_components(mesh);
    found.border_loops = border_loops(mesh);
    Eigen::AlignedBox3d box;
    for (const auto vertex : mesh.vertices()) {
        if (mesh.is_isolated(vertex)) continue;
        ++found.vertices;
        const auto& p = mesh.point(vertex);
        box.extend(Vec3(p[0], p[1], p[2]));
    }
    for (const auto face : mesh.faces()) found.area_mm2 += mesh.calc_face_area(face);
    if (!box.isEmpty()) found.size_mm = box.sizes();
}

InspectedRegion inspected(const Region& region) {
    const auto length = [&](const std::vector<Index>& loop) {
        const auto lengths = loop_lengths(region, loop);
        return std::accumulate(lengths.begin(), lengths.end(), 0.0);
    };
    InspectedRegion found{region.name, region.positions.size(), region.triangles.size(),
                          surface_area(region), length(region.border)};
    const auto curvatures = hole_curvatures(region);
    for (std::size_t k = 0; k < region.holes.size(); ++k) {
        const auto& hole = region.holes[k];
        found.holes.push_back({length(hole), region.position(hole.front()), curvatures[k]});
    }
    return found;
}

}  // namespace

Inspection inspect(std::string_view model, const FlattenOptions& options) {
    Progress progress;
    ReadModel read = read_model(model, options, progress);
    Inspection found;
    found.file_vertices = read.vertices;
    found.file_triangles = read.triangles;
    found.groups = std::move(read.groups);
    found.unit_mm = read.surface.unit_mm;
    found.warnings = read.surface.warnings;
    found.repairs = read.surface.repairs;
    measure_surface(read.surface.mesh, found);
    try {
        found.plan = make_plan(read.surface, options.request, Progress(), options.threads);
        if (const auto& landmarks = found.plan.landmarks)
            found.warnings.insert(found.warnings.end(), landmarks->warnings.begin(),
                                  landmarks->warnings.end());
        Prepared prepared = prepare(std::move(read.surface), found.plan, progress);
        found.warnings = std::move(prepared.warnings);
        for (const Region& region : prepared.regions) found.regions.push_back(inspected(region));
    } catch (const Error& error) {
        found.fault = error;
    }
    return found;
}

}  // namespace lastflat
