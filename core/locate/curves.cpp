#include "core/locate/curves.h"

#include <cstdio>
#include <set>

namespace lastflat {
namespace {

std::string millimetres(double length) {
    char text[40];
    std::snprintf(text, sizeof text, "%.3f mm", length);
    return text;
}

[[noreturn]] void fail(const CurveSource& source, std::size_t item, const std::string& what,
                       std::optional<Vec3> position = std::nullopt) {
    Error error(ErrorCode::curve_invalid,
                "curve '" + source.name + "', item " + std::to_string(item) + ": " + what);
    error.at_option({"curves", source.name, "vertices", std::to_string(item)});
    if (position) error.at_position(*position);
    throw error;
}

Index located_vertex(const SurfaceMesh& surface, const CurveSource& source, std::size_t item) {
    const Index id = source.vertices[item];
    if (id < 0 || id >= static_cast<Index>(surface.welded_to.size())) {
        fail(source, item,
             "vertex " + std::to_string(id) + " does not exist (the model has " +
                 std::to_string(surface.welded_to.size()) + ", counted from 0)");
    }
    const Index vertex = surface.welded_to[static_cast<std::size_t>(id)];
    if (!surface.is_on_surface(vertex)) {
        fail(source, item,
             "vertex " + std::to_string(id) + " is not on the selected faces, at " +
                 place(surface.position(vertex)),
             surface.position(vertex));
    }
    return vertex;
}

void check_edge(const SurfaceMesh& surface, const CurveSource& source, std::size_t item,
                const Curve& curve) {
    const Index a = curve.vertices[item - 1], b = curve.vertices[item];
    const auto edge =
        surface.mesh.find_halfedge(OpenMesh::VertexHandle(a), OpenMesh::VertexHandle(b));
    if (edge.is_valid()) return;
    fail(source, item,
         "vertices " + std::to_string(source.vertices[item - 1]) + " and " +
             std::to_string(source.vertices[item]) + " share no edge; they are " +
             millimetres((surface.position(a) - surface.position(b)).norm()) + " apart, at " +
             place(surface.position(a)),
         surface.position(a));
}

Curve located(const SurfaceMesh& surface, const CurveSource& source) {
    if (source.vertices.size() < 2) fail(source, 0, "a curve needs two vertices");
    Curve curve{source.name, {}};
    std::set<Index> seen;
    for (std::size_t i = 0; i < source.vertices.size(); ++i) {
        const Index vertex = located_vertex(surface, source, i);
        const bool closes =
            i + 1 == source.vertices.size() && i > 2 && vertex == curve.vertices.front();
        if (!seen.insert(vertex).second && !closes) {
            fail(source, i,
                 "the curve meets itself at vertex " + std::to_string(source.vertices[i]) +
                     ", at " + place(surface.position(vertex)),
                 surface.position(vertex));
        }
        curve.vertices.push_back(vertex);
        if (i > 0) check_edge(surface, source, i, curve);
    }
    return curve;
}

}  // namespace

Curves locate_curves(const SurfaceMesh& surface, const std::vector<CurveSource>& sources) {
    Curves curves;
    for (const CurveSource& source : sources) curves.push_back(located(surface, source));
    return curves;
}

}  // namespace lastflat
