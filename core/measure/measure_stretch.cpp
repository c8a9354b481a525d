#include <algorithm>
#include <cmath>

#include "core/measure/report.h"
#include "core/measure/stretch.h"
#include "core/numerics/geometry.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

constexpr std::size_t most_listed = 10;
/// Points nearer to each other than this share of the region's size are one.
constexpr double apart = 0.05;

struct Leather {
    double larger, smaller;  ///< principal strains when lasted, percent: above 0 stretched
    double surface;          ///< mm^2 on the last
    Index triangle;
    [[nodiscard]] double worst() const {
        return std::abs(larger) > std::abs(smaller) ? larger : smaller;
    }
};

/// The value below which `share` of the area lies; `values` ascending.
double percentile(const std::vector<std::pair<double, double>>& values, double total,
                  double share) {
    double sum = 0.0;
    for (const auto& [value, area] : values) {
        sum += area;
        if (sum >= share * total) return value;
    }
    return values.back().first;
}

void sort_by_value(std::vector<std::pair<double, double>>& values) {
    std::sort(values.begin(), values.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
}

StretchPercentiles percentiles(std::vector<std::pair<double, double>> values, double total) {
    sort_by_value(values);
    return {percentile(values, total, 0.01), percentile(values, total, 0.05),
            percentile(values, total, 0.50), percentile(values, total, 0.95),
            percentile(values, total, 0.99)};
}

std::vector<WorstStrain> worst_strains(const Region& region, std::vector<Leather> leather,
                                       double total) {
    const auto less = [](const Leather& a, const Leather& b) {
        return std::pair(std::abs(a.worst()), -a.triangle) <
               std::pair(std::abs(b.worst()), -b.triangle);
    };
    std::make_heap(leather.begin(), leather.end(), less);
    std::vector<WorstStrain> worst;
    for (auto end = leather.end(); end != leather.begin(); --end) {
        std::pop_heap(leather.begin(), end, less);  // to its place before the end
        const Leather& l = *(end - 1);
        if (worst.size() == most_listed || std::abs(l.worst()) < tolerance::noticed_strain_percent)
            break;
        const Triangle& t = region.triangles[static_cast<std::size_t>(l.triangle)];
        const Vec3 middle = centroid(region, t);
        const bool known = std::any_of(worst.begin(), worst.end(), [&](const WorstStrain& p) {
            return (p.position - middle).norm() < apart * std::sqrt(total);
        });
        if (!known) worst.push_back({middle, l.larger, l.smaller});
    }
    return worst;
}

double strain_behind_toe(const Region& region, const std::vector<Leather>& leather,
                         const FeatherlineSide& side) {
    const Vec3 axis = (side.toe - side.seat) / (side.toe - side.seat).squaredNorm();
    std::vector<std::pair<double, double>> strains;
    double behind = 0.0;
    for (const Leather& l : leather) {
        const Vec3 middle = centroid(region, region.triangles[at(l.triangle)]);
        if (axis.dot(middle - side.seat) > side.ends[0].share) continue;
        strains.emplace_back(std::abs(l.worst()), l.surface);
        behind += l.surface;
    }
    if (strains.empty()) return 0.0;
    sort_by_value(strains);
    return percentile(strains, behind, 0.99);
}

}  // namespace

StretchReport measure_stretch(const Region& region, const Points2& uv,
                              const std::optional<MaterialLimits>& material,
                              const std::optional<FeatherlineSide>& side) {
    std::vector<Leather> leather;
    std::vector<std::pair<double, double>> larger, smaller, area;
    StretchReport report{};
    double total = 0.0, beyond = 0.0;
    for (std::size_t i = 0; i < region.triangles.size(); ++i) {
        const Stretch s = stretch_of(region, uv, region.triangles[i]);
        const Leather l{100.0 * (s.G - 1.0), 100.0 * (s.g - 1.0), s.area_3d, static_cast<Index>(i)};
        leather.push_back(l);
        larger.emplace_back(l.larger, l.surface);
        smaller.emplace_back(l.smaller, l.surface);
        area.emplace_back(100.0 * (s.G * s.g - 1.0), l.surface);
        total += l.surface;
        report.most_stretched_percent = std::max(report.most_stretched_percent, l.larger);
        report.most_gathered_percent = std::min(report.most_gathered_percent, l.smaller);
        if (material && (l.larger > material->stretch_max_percent ||
                         -l.smaller > material->compress_max_percent))
            beyond += l.surface;
    }
    report.larger = percentiles(std::move(larger), total);
    report.smaller = percentiles(std::move(smaller), total);
    report.area = percentiles(std::move(area), total);
    if (side) report.behind_toe_percent = strain_behind_toe(region, leather, *side);
    report.worst = worst_strains(region, std::move(leather), total);
    if (material) {
        report.beyond_material = beyond / total;
        report.material_verdict = beyond == 0.0            ? Verdict::pass
                                  : beyond <= 0.01 * total ? Verdict::warn
                                                           : Verdict::fail;
    }
    return report;
}

}  // namespace lastflat
