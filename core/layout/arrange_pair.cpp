#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/layout/base_line.h"
#include "core/layout/sheet.h"

namespace lastflat {
namespace {

/// Whether most of the piece lies below its base line.
bool hangs_below(const Region& region, const Chart& chart, const BaseLine& line) {
    double mean = 0.0;
    for (const Index v : region.border) mean += chart.uv[static_cast<std::size_t>(v)].y();
    mean /= static_cast<double>(region.border.size());
    return mean < 0.5 * (chart.uv[static_cast<std::size_t>(line.seat)].y() +
                         chart.uv[static_cast<std::size_t>(line.toe)].y());
}

std::vector<bool> mirrored_regions(const std::vector<Region>& regions,
                                   const std::vector<Chart>& charts) {
    const Vec3 axis = long_axis(regions);
    const Vec3 up = area_vector(regions.front()).cross(axis);
    std::vector<bool> mirrored;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        const auto line = named_base_line(regions[r]);
        mirrored.push_back(line ? hangs_below(regions[r], charts[r], *line)
                                : area_vector(regions[r]).cross(axis).dot(up) < 0.0);
    }
    return mirrored;
}

Points2 placed_outline(const Region& region, const Chart& chart, const Placement& placement) {
    Points2 outline;
    for (const Index v : region.border) {
        outline.push_back(placement.apply(chart.uv[static_cast<std::size_t>(v)]));
    }
    return outline;
}

/// The outline's highest (sign +1) or lowest (sign -1) y over each cell of a grid along x. A cell
/// takes every edge that reaches into it at its extreme, so the profile is never too low.
std::vector<double> profile(const Points2& outline, double cell, std::size_t cells, double sign) {
    std::vector<double> y(cells, -HUGE_VAL);
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
        const double left = std::min(a.x(), b.x()), right = std::max(a.x(), b.x());
        const auto first = static_cast<std::size_t>(std::max(0.0, left / cell));
        for (std::size_t c = first; c < cells && static_cast<double>(c) * cell <= right; ++c) {
            const double x0 = std::clamp(static_cast<double>(c) * cell, left, right);
            const double x1 = std::clamp(static_cast<double>(c + 1) * cell, left, right);
            for (const double x : {x0, x1}) {
                const double t = right > left ? (x - a.x()) / (b.x() - a.x()) : 0.0;
                y[c] = std::max(y[c], sign * (a.y() + t * (b.y() - a.y())));
            }
            if (right <= left) y[c] = std::max({y[c], sign * a.y(), sign * b.y()});
        }
    }
    return y;
}

/// 1 mm, or coarser where a piece is so large that its profile would have too many cells.
double profile_cell(const std::vector<Chart>& charts) {
    double largest = 0.0;
    for (const Chart& chart : charts) {
        Eigen::AlignedBox2d box;
        for (const Vec2& p : chart.uv) box.extend(p);
        largest = std::max(largest, box.sizes().x());
    }
    return std::max(1.0, largest / 4096.0);
}

}  // namespace

Vec2 Placement::apply(const Vec2& point) const {
    const Vec2 p(point.x(), mirrored ? -point.y() : point.y());
    const double c = std::cos(rotation), s = std::sin(rotation);
    return translation + Vec2(c * p.x() - s * p.y(), s * p.x() + c * p.y());
}

Sheet arrange_pair(const std::vector<Region>& regions, const std::vector<Chart>& charts,
                   double gap) {
    Sheet sheet;
    const auto mirrored = mirrored_regions(regions, charts);
    const double cell = profile_cell(charts);
    std::vector<double> ceiling;  // of what lies on the sheet already
    for (std::size_t r = 0; r < regions.size(); ++r) {
        Placement placement{mirrored[r], 0.0, Vec2::Zero()};
        Eigen::AlignedBox2d box;
        for (const Vec2& p : placed_outline(regions[r], charts[r], placement)) box.extend(p);
        placement.translation = Vec2::Zero() - box.min();
        const Points2 outline = placed_outline(regions[r], charts[r], placement);
        const auto cells = static_cast<std::size_t>(box.sizes().x() / cell) + 1;
        const auto floor = profile(outline, cell, cells, -1.0);
        double lift = 0.0;
        for (std::size_t c = 0; c < std::min(cells, ceiling.size()); ++c) {
            lift = std::max(lift, ceiling[c] + gap + floor[c]);
        }
        placement.translation.y() += lift;
        auto top = profile(outline, cell, cells, 1.0);
        ceiling.resize(std::max(ceiling.size(), cells), -HUGE_VAL);
        for (std::size_t c = 0; c < cells; ++c) ceiling[c] = std::max(ceiling[c], top[c] + lift);
        sheet.width = std::max(sheet.width, box.sizes().x());
        sheet.height = std::max(sheet.height, box.sizes().y() + lift);
        sheet.placements.push_back(placement);
    }
    return sheet;
}

}  // namespace lastflat
