#include "core/plan/plan.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "core/locate/curves.h"
#include "core/locate/surface_search.h"
#include "core/text.h"

namespace lastflat {
namespace {

/// Whether a line comes to the filling, looked at from point to point.
bool comes_to(const SurfaceMesh& surface, const SurfaceSearch& search, const Points3& line,
              const FilledFeature& feature) {
    return std::any_of(line.begin(), line.end(), [&](const Vec3& p) {
        if ((p - feature.centre).norm() > feature.across_mm) return false;
        const auto faces = faces_at(surface, search.nearest(p).point);
        return std::any_of(faces.begin(), faces.end(), [&](Index f) { return feature.holds(f); });
    });
}

/// A curve over what was filled is bridged there.
void warn_where_filled(const SurfaceMesh& surface, Landmarks& found) {
    if (surface.filled.empty()) return;
    const SurfaceSearch search(surface);
    for (const CurveSource& curve : found.curves) {
        const Points3& points = points_of(curve);
        for (const FilledFeature& feature : surface.filled) {
            if (!comes_to(surface, search, points, feature)) continue;
            found.warnings.push_back({"landmark_unsure",
                                      "the " + curve.name + " bridges a feature of the last at " +
                                          position_text(feature.centre) + ", " +
                                          fixed_text(feature.across_mm, 1) +
                                          " mm across; look at it there, and send it corrected "
                                          "as a curve",
                                      feature.centre});
        }
    }
}

/// What was found, where the request does not say it.
void fill_in(const SurfaceMesh& surface, Landmarks& found, Request& request) {
    std::erase_if(found.curves, [&](const CurveSource& curve) {
        return std::any_of(request.curves.begin(), request.curves.end(),
                           [&](const CurveSource& own) { return own.name == curve.name; });
    });
    std::move(found.curves.begin(), found.curves.end(), std::back_inserter(request.curves));
    found.curves.clear();
    found.cut.holes = request.cut.holes;
    found.cut.features = surface.filled.empty() ? request.cut.features : FeatureRule::fill;
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

bool is_bare(const SurfaceMesh& surface, const Request& request) {
    return !says_how_to_cut(request) && !is_open(surface);
}

Plan make_plan(const SurfaceMesh& surface, const Request& request, const Progress& progress,
               std::size_t threads) {
    if (!is_bare(surface, request)) return make_plan(surface, request, std::nullopt);
    return make_plan(surface, request, find_landmarks(surface, progress, threads));
}

Plan make_plan(const SurfaceMesh& surface, const Request& request, std::optional<Landmarks> found) {
    Plan plan{request};
    if (found) {
        plan.found = request.curves.empty() ? Plan::Found::all : Plan::Found::some;
        plan.landmarks = std::move(found);
        warn_where_filled(surface, *plan.landmarks);
        fill_in(surface, *plan.landmarks, plan.request);
    }
    name_welded_vertices(surface, plan.request);
    auto& curves = plan.request.curves;
    std::sort(curves.begin(), curves.end(), [](const CurveSource& a, const CurveSource& b) {
        return std::tuple(turn(a.form), a.name) < std::tuple(turn(b.form), b.name);
    });
    return plan;
}

}  // namespace lastflat
