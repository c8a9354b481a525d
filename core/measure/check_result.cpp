#include "core/measure/check_result.h"

#include "core/constrain/constraint.h"

namespace lastflat {
namespace {

std::string first_places(const Region& region, const std::vector<Index>& triangles) {
    std::string text;
    for (std::size_t i = 0; i < triangles.size() && i < 3; ++i) {
        const Triangle& t = region.triangles[static_cast<std::size_t>(triangles[i])];
        text += (i == 0 ? " at " : ", ") + position_text(region.position(t[0]));
    }
    return triangles.size() > 3 ? text + " ..." : text;
}

void check_crossings(const Region& region, const Points2& uv, MethodName method,
                     std::vector<Warning>& warnings) {
    const auto crossings = border_crossings(region, uv);
    if (crossings.empty()) return;
    const auto& [a, b] = crossings.front();
    const std::string what = "region '" + region.name + "': the flat border crosses itself " +
                             std::to_string(crossings.size()) + " times, first where " +
                             position_text(a) + " meets " + position_text(b);
    if (method == MethodName::isometric) {
        throw Error(ErrorCode::border_crosses, what + "; cut the region so that it opens wider")
            .at_option({"regions", region.name})
            .at_position(a);
    }
    warnings.push_back({"border_crosses", what, a});
}

}  // namespace

void check_result(const Region& region, const Points2& uv, MethodName method,
                  const Metrics& metrics, std::vector<Warning>& warnings) {
    if (metrics.flipped_triangles > 0) {
        const auto flipped = flipped_triangles(region, uv);
        throw Error(ErrorCode::method_failed, "region '" + region.name + "': the map folds, " +
                                                  std::to_string(metrics.flipped_triangles) +
                                                  " triangles are flipped," +
                                                  first_places(region, flipped))
            .at_option({"method"})
            .at_position(
                region.position(region.triangles[static_cast<std::size_t>(flipped.front())][0]))
            .at_triangles(source_triangles(region, flipped));
    }
    if (metrics.border_crossings > 0) check_crossings(region, uv, method, warnings);
}

void check_constraints_kept(const std::vector<ConstraintReport>& reports,
                            const std::vector<Constraint>& constraints,
                            std::vector<Warning>& warnings) {
    for (const ConstraintReport& report : reports) {
        if (report.kept) continue;
        const Constraint& constraint = constraints[report.constraint];
        const std::string what = "region '" + report.region + "': " + title(constraint) +
                                 " is off by " + std::to_string(report.residual_mm) + " mm at " +
                                 position_text(report.position);
        if (!report.relaxed) {
            throw Error(ErrorCode::constraints_infeasible, what)
                .at_option(constraint.option)
                .at_position(report.position);
        }
        warnings.push_back(
            {"constraint_relaxed", what + ", because others are more important", report.position});
    }
}

}  // namespace lastflat
