// A face of our own, with the vertex counts of the paper's: 1,607 vertices, 68 on the border.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "core/cut/find_border.h"
#include "core/cut/region.h"

namespace lastflat::test {

/// Depth of the face over (x, y), mm; nose, brow, eye sockets, lips and chin on half an ellipsoid.
inline double face_depth(double x, double y) {
    const auto bump = [&](double cx, double cy, double wx, double wy, double height) {
        const double dx = (x - cx) / wx, dy = (y - cy) / wy;
        return height * std::exp(-dx * dx - dy * dy);
    };
    const double rest = 1.0 - std::pow(x / 82.0, 2) - std::pow(y / 112.0, 2);
    return 85.0 * std::sqrt(std::max(rest, 0.0)) + bump(0, -8, 11, 20, 20) +
           bump(0, -22, 14, 9, 12) + bump(0, 34, 40, 10, 5) + bump(-29, 18, 15, 10, -12) +
           bump(29, 18, 15, 10, -12) + bump(0, -48, 22, 5, 7) + bump(0, -58, 20, 4, 5) +
           bump(0, -82, 18, 12, 8);
}

/// Rings around the nose, finer inside than at the border, as a decimated scan is.
inline Region face() {
    std::vector<int> counts{1};
    int total = 1;
    constexpr int rings = 26, inner = 1607 - 68;
    for (int k = 1; k < rings - 1; ++k) {
        const double t = static_cast<double>(k) / rings;
        counts.push_back(static_cast<int>(std::lround(6 + 76 * std::sin(2.1 * t))));
        total += counts.back();
    }
    counts.push_back(inner - total);  // 80: what is left makes the count exact
    counts.push_back(68);

    Region region;
    region.name = "face";
    std::vector<Index> first;
    for (std::size_t k = 0; k < counts.size(); ++k) {
        first.push_back(static_cast<Index>(region.positions.size()));
        const double radius = static_cast<double>(k) / rings;
        for (int i = 0; i < counts[k]; ++i) {
            const double angle =
                2.0 * std::numbers::pi * (i + 0.5 * static_cast<double>(k % 2)) / counts[k];
            const double x = 78.0 * radius * std::cos(angle), y = 106.0 * radius * std::sin(angle);
            region.positions.emplace_back(x, y, face_depth(x, y));
        }
    }
    for (std::size_t k = 0; k + 1 < counts.size(); ++k) {  // close the gap between two rings
        const int a = counts[k], b = counts[k + 1];
        const auto in = [&](int i) { return first[k] + static_cast<Index>(i % a); };
        const auto out = [&](int j) { return first[k + 1] + static_cast<Index>(j % b); };
        const double shift_in = 0.5 * static_cast<double>(k % 2),
                     shift_out = 0.5 * static_cast<double>((k + 1) % 2);
        for (int i = 0, j = 0; i < (a > 1 ? a : 0) || j < b;) {
            const double next_in = a > 1 ? (i + 1 + shift_in) / a : 2.0;
            const double next_out = (j + 1 + shift_out) / b;
            if (j < b && (next_out <= next_in || i >= a)) {
                region.triangles.push_back({in(i), out(j), out(j + 1)});
                ++j;
            } else {
                region.triangles.push_back({in(i), out(j), in(i + 1)});
                ++i;
            }
        }
    }
    for (Index v = 0; v < static_cast<Index>(region.positions.size()); ++v)
        region.source_vertices.push_back(v);
    find_border(region);
    return region;
}

}  // namespace lastflat::test
