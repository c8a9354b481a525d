#include "core/measure/strain_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/measure/stretch.h"
#include "core/numerics/geometry.h"

namespace lastflat {
namespace {

double strain_of(const Stretch& s, Shading shading) {
    switch (shading) {
        case Shading::area: return 100.0 * (s.G * s.g - 1.0);
        case Shading::stretch: return 100.0 * (s.G - 1.0);
        case Shading::gather: return 100.0 * (s.g - 1.0);
        // Fibres half-way between the principal directions include twice the angle of slope g / G.
        case Shading::shear: return 90.0 - 360.0 / std::numbers::pi * std::atan2(s.g, s.G);
        case Shading::plain: return 0.0;
    }
    return 0.0;
}

}  // namespace

std::vector<double> triangle_strains(const Region& region, const Points2& uv, Shading shading) {
    std::vector<double> strains;
    if (shading == Shading::plain) return strains;
    strains.reserve(region.triangles.size());
    for (const Triangle& t : region.triangles)
        strains.push_back(strain_of(stretch_of(region, uv, t), shading));
    return strains;
}

std::vector<double> vertex_means(const Region& region, const std::vector<double>& of_triangles) {
    std::vector<double> sums(region.positions.size(), 0.0), areas(region.positions.size(), 0.0);
    for (std::size_t t = 0; t < of_triangles.size(); ++t) {
        const Triangle& triangle = region.triangles[t];
        const double area = doubled_area_vector(region, triangle).norm();
        for (const Index v : triangle) {
            sums[at(v)] += area * of_triangles[t];
            areas[at(v)] += area;
        }
    }
    for (std::size_t v = 0; v < sums.size(); ++v) sums[v] /= areas[v];
    return sums;
}

std::size_t worst_triangle(const std::vector<double>& strains, Shading shading) {
    const auto badness = [&](double strain) {
        switch (shading) {
            case Shading::stretch: return strain;
            case Shading::gather: return -strain;
            case Shading::area:
            case Shading::shear:
            case Shading::plain: break;
        }
        return std::abs(strain);
    };
    const auto worst = std::max_element(strains.begin(), strains.end(), [&](double a, double b) {
        return badness(a) < badness(b);
    });
    return static_cast<std::size_t>(worst - strains.begin());
}

}  // namespace lastflat
