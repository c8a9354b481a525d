#include "core/plan/plan.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "core/locate/curves.h"

namespace lastflat {
namespace {

bool is_open(const SurfaceMesh& surface) {
    return std::any_of(surface.mesh.edges_begin(), surface.mesh.edges_end(),
                       [&](auto edge) { return surface.mesh.is_boundary(edge); });
}

bool is_bare(const SurfaceMesh& surface, const Request& request) {
    return request.cut.cuts.empty() && request.cut.seams.empty() && request.cut.regions.empty() &&
           request.weld.groups.empty() && !is_open(surface);
}

/// What was found, where the request does not say it.
void fill_in(Landmarks& found, Request& request) {
    std::erase_if(found.curves, [&](const CurveSource& curve) {
        return std::any_of(request.curves.begin(), request.curves.end(),
                           [&](const CurveSource& own) { return own.name == curve.name; });
    });
    std::move(found.curves.begin(), found.curves.end(), std::back_inserter(request.curves));
    found.curves.clear();
    found.cut.holes = request.cut.holes;
    request.cut = std::exchange(found.cut, {});
    if (request.constraints.empty())
        request.constraints = {{Lock{curve_name::centre_front}}, {Lock{curve_name::heel}}};
}

/// A vertex that was welded to another is named by that one.
void name_welded_vertices(const SurfaceMesh& surface, Request& request) {
    const auto rename = [&](Index& vertex) {
        if (surface.is_on_surface(vertex)) vertex = surface.welded_to[at(vertex)];
    };
    for (Constraint& constraint : request.constraints) {
        if (auto* pin = std::get_if<Pin>(&constraint.demand)) rename(pin->vertex);
    }
    for (Zone& zone : request.weights.zones) {
        rename(zone.vertex);
        for (Index& vertex : zone.vertices) rename(vertex);
    }
}

}  // namespace

Plan make_plan(const SurfaceMesh& surface, const Request& request) {
    Plan plan{request};
    if (is_bare(surface, request)) {
        plan.found = request.curves.empty() ? Plan::Found::all : Plan::Found::some;
        plan.landmarks = find_landmarks(surface);
        fill_in(*plan.landmarks, plan.request);
    }
    name_welded_vertices(surface, plan.request);
    auto& curves = plan.request.curves;
    std::sort(curves.begin(), curves.end(), [](const CurveSource& a, const CurveSource& b) {
        return std::tuple(turn(a.form), a.name) < std::tuple(turn(b.form), b.name);
    });
    return plan;
}

}  // namespace lastflat
