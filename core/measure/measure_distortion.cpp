// Based on: Sander, Snyder, Gortler, Hoppe, "Texture Mapping Progressive Meshes", SIGGRAPH 2001.
// Written from coordinates, without the optimiser's code, so that the one checks the other.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/measure/report.h"
#include "core/numerics/polygon.h"

namespace lastflat {
namespace {

/// Singular values G >= g of the map plane -> surface, and both areas.
struct Stretch {
    double G, g, area_3d, area_2d;
};

Stretch stretch_of(const Region& region, const Points2& uv, const Triangle& t) {
    const Vec3 &q1 = region.position(t[0]), &q2 = region.position(t[1]),
               &q3 = region.position(t[2]);
    const Vec2 &p1 = uv[static_cast<std::size_t>(t[0])], &p2 = uv[static_cast<std::size_t>(t[1])],
               &p3 = uv[static_cast<std::size_t>(t[2])];
    const double doubled = doubled_area(p1, p2, p3);
    const Vec3 S_s =
        (q1 * (p2.y() - p3.y()) + q2 * (p3.y() - p1.y()) + q3 * (p1.y() - p2.y())) / doubled;
    const Vec3 S_t =
        (q1 * (p3.x() - p2.x()) + q2 * (p1.x() - p3.x()) + q3 * (p2.x() - p1.x())) / doubled;
    const double a = S_s.dot(S_s), b = S_s.dot(S_t), c = S_t.dot(S_t);
    const double root = std::sqrt((a - c) * (a - c) + 4.0 * b * b);
    const double area_3d = 0.5 * (q2 - q1).cross(q3 - q1).norm();
    const double G = std::sqrt(0.5 * (a + c + root));
    // G g is the ratio of the areas; subtracting root instead would cancel.
    return {G, 2.0 * area_3d / std::abs(doubled) / G, area_3d, 0.5 * doubled};
}

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

Verdict area_verdict(double error) {
    return error <= 0.005 ? Verdict::pass : error <= 0.015 ? Verdict::warn : Verdict::fail;
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
    m.area_verdict = area_verdict(m.area_error);
    Points2 outline;
    for (const Index v : region.border) outline.push_back(uv[static_cast<std::size_t>(v)]);
    m.border_crossings = static_cast<Index>(self_crossings(outline).size());
    return m;
}

std::vector<double> signed_stretches(const Region& region, const Points2& uv) {
    std::vector<double> stretches;
    for (const Triangle& t : region.triangles) {
        const Stretch s = stretch_of(region, uv, t);
        const double larger = 1.0 / s.g, smaller = 1.0 / s.G;
        stretches.push_back(larger * smaller >= 1.0 ? larger : smaller);
    }
    return stretches;
}

}  // namespace lastflat
