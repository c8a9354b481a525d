// A small OBJ through the whole method. The first byte chooses the method, what becomes of holes,
// and the locks; the curve, a cut or a seam, is the path over the first vertices of the file. What
// is returned must be what was promised.
#include "core/flatten.h"

#include <cmath>

#include "core/numerics/tolerances.h"
#include "tests/fuzz/mesh_checks.h"

namespace {

using namespace lastflat;

FlattenOptions options_of(std::uint8_t choice) {
    FlattenOptions options;
    options.limits = fuzz::small_limits();
    options.limits.vertices = 400;
    options.limits.triangles = 800;
    const int path = choice >> 4;  // edges of the curve; it is cut and locked
    const MethodName locked[] = {MethodName::isometric, MethodName::isometric,
                                 MethodName::geodesic_fan, MethodName::mean_value};
    const MethodName free[] = {MethodName::mips, MethodName::green_lagrange, MethodName::harmonic,
                               MethodName::virtual_border};
    options.request.method.name =
        path == 0 && (choice & 8) != 0 ? free[choice % 4] : locked[choice % 4];
    options.request.method.angles =
        (choice & 4) != 0 ? AngleRule::averaged_conformal : AngleRule::curvature;
    options.request.method.border = (choice & 4) != 0 ? BorderShape::square : BorderShape::circle;
    options.request.cut.holes = static_cast<HoleRule>(choice % 3);
    if (path > 0) {
        VertexPath heel;
        for (Index v = 0; v <= path; ++v) heel.vertices.push_back(v);
        options.request.curves.push_back({"heel", heel});
        options.request.constraints.push_back(
            {Lock{"heel", (choice & 8) != 0 ? Keep::total : Keep::edges}});
        (choice % 2 == 0 ? options.request.cut.cuts : options.request.cut.seams).push_back("heel");
    }
    return options;
}

void check(const FlattenResult& result) {
    if (result.plan.request.method.name == MethodName::isometric) {
        for (const ConstraintReport& report : result.constraints) fuzz::require(report.kept);
    }
    for (const FlatRegion& flat : result.regions) {
        for (const Vec2& p : flat.chart.uv) fuzz::require(p.allFinite());
        fuzz::require(flat.chart.uv.size() == flat.region.positions.size());
        fuzz::require(flat.metrics.flipped_triangles == 0);
        if (result.plan.request.method.name != MethodName::isometric) continue;
        fuzz::require(flat.metrics.border_crossings == 0);
        for (const CurveReport& curve : flat.curves) {
            fuzz::require(!curve.locked || curve.verdict == Verdict::pass);
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    Progress progress;
    try {
        check(flatten(fuzz::text(data + 1, size - 1), options_of(data[0]), progress));
    } catch (const Error&) {
    }
    return 0;
}
