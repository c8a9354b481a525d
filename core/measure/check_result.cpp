#include "core/measure/check_result.h"

#include <algorithm>
#include <numbers>

#include "core/constrain/constraint.h"
#include "core/text.h"

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

/// A border encloses no more in the plane than a circle of its length does.
std::string likely_cause(const Region& region, double area) {
    const double around = loop_length(region, region.border);
    if (around * around < 4.0 * std::numbers::pi * area)
        return "its border of " + fixed_text(around, 0) + " mm is too short for its surface of " +
               fixed_text(area / 100.0, 0) +
               " cm2: a cut is missing, or it was opened at a hole instead of its rim";
    if (!region.holes.empty())
        return "a hole of it was kept; open it with \"holes\": \"open\", or close the model there";
    return "it bends more than a flat piece can follow; cut or sew it there";
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

void check_distortion(const Region& region, const Metrics& metrics, const StretchReport& stretch,
                      bool was_found, std::vector<Warning>& warnings) {
    constexpr double most_energy = 1.02, most_strain_percent = 25.0, most_behind_toe = 12.0;
    const double strain = std::max(
        {stretch.larger.p99, -stretch.larger.p01, stretch.smaller.p99, -stretch.smaller.p01});
    const double behind = stretch.behind_toe_percent.value_or(0.0);
    if (metrics.symmetric_dirichlet <= most_energy && strain <= most_strain_percent &&
        behind <= most_behind_toe)
        return;
    const std::string behind_text =
        behind > most_behind_toe ? ", behind the toe by " + fixed_text(behind, 0) + " %" : "";
    const Vec3 position =
        stretch.worst.empty() ? region.position(region.border[0]) : stretch.worst[0].position;
    const std::string what = "region '" + region.name + "': mean energy " +
                             fixed_text(metrics.symmetric_dirichlet, 3) +
                             ", a hundredth of the surface strains by " + fixed_text(strain, 0) +
                             " % or more" + behind_text + ", most by " + position_text(position) +
                             "; " + likely_cause(region, metrics.area_3d_mm2);
    if (was_found) throw Error(ErrorCode::distortion_extreme, what).at_position(position);
    warnings.push_back({"distortion_extreme", what, position});
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
