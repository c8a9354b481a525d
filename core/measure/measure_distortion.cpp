// Based on: Sander, Snyder, Gortler, Hoppe, "Texture Mapping Progressive Meshes", SIGGRAPH 2001.
// Written from coordinates, without the optimiser's code, so that the one checks the other.
#include <algorithm>
#include <cmath>

#include "core/constrain/constraint.h"
#include "core/measure/report.h"
#include "core/measure/stretch.h"

namespace lastflat {
namespace {

/// The smallest value that covers `share` of the total weight.
double weighted_quantile(std::vector<std::pair<double, double>> values, double share) {
    std::sort(values.begin(), values.end());
    double total = 0.0, sum = 0.0;
    for (const auto& [value, weight] : values) total += weight;
    for (const auto& [value, weight] : values) {
        sum += weight;
        if (sum >= share * total) return value;
    }
    return values.back().first;
}

}  // namespace

Metrics measure_distortion(const Region& region, const Points2& uv) {
    Metrics m{};
    double l2 = 0.0, angle = 0.0, dirichlet = 0.0;
    std::vector<std::pair<double, double>> area_errors;
    for (const Triangle& t : region.triangles) {
        const Stretch s = stretch_of(region, uv, t);
        m.area_3d_mm2 += s.area_3d;
        m.area_2d_mm2 += s.area_2d;
        l2 += s.area_3d * 0.5 * (s.G * s.G + s.g * s.g);
        m.stretch_linf = std::max(m.stretch_linf, s.G);
        angle += s.area_3d * 0.5 * (s.G / s.g + s.g / s.G);
        dirichlet +=
            s.area_3d * 0.25 * (s.G * s.G + s.g * s.g + 1.0 / (s.G * s.G) + 1.0 / (s.g * s.g));
        area_errors.emplace_back(std::abs(s.area_2d / s.area_3d - 1.0), s.area_3d);
        if (!(s.area_2d > 0.0)) ++m.flipped_triangles;
    }
    m.stretch_l2 = std::sqrt(l2 / m.area_3d_mm2);
    const double scale = std::sqrt(m.area_2d_mm2 / m.area_3d_mm2);
    m.stretch_l2_normalised = m.stretch_l2 * scale;
    m.stretch_linf_normalised = m.stretch_linf * scale;
    m.symmetric_dirichlet = dirichlet / m.area_3d_mm2;
    m.angle_distortion = angle / m.area_3d_mm2;
    m.area_error = std::abs(m.area_2d_mm2 - m.area_3d_mm2) / m.area_3d_mm2;
    m.area_error_p95 = weighted_quantile(std::move(area_errors), 0.95);
    m.border_crossings = static_cast<Index>(border_crossings(region, uv).size());
    return m;
}

std::optional<Verdict> area_verdict(const Region& region, const Metrics& metrics,
                                    const std::vector<Constraint>& constraints) {
    const double percent = 100.0 * (metrics.area_2d_mm2 / metrics.area_3d_mm2 - 1.0);
    std::optional<double> beyond;
    for (const Constraint& constraint : constraints) {
        const auto* asked = std::get_if<TotalArea>(&constraint.demand);
        if (asked == nullptr || !binds(asked->region, region)) continue;
        beyond = std::max(
            {beyond.value_or(0.0), percent - asked->max_percent, asked->min_percent - percent});
    }
    if (!beyond) return std::nullopt;
    return *beyond <= 0.5 ? Verdict::pass : *beyond <= 1.5 ? Verdict::warn : Verdict::fail;
}

}  // namespace lastflat
