// Based on: Lee, Kim, Lee, "Mesh Parameterization with a Virtual Boundary", Computers & Graphics
// 2002 (one layer; partners over the hull instead of radially).
#include "core/border/convex_border.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/error.h"
#include "core/numerics/polygon.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

/// Arc length at each border vertex, twice around, so that any start has a whole turn ahead.
std::vector<double> arc_lengths(const std::vector<double>& lengths) {
    std::vector<double> arc{0.0};
    for (std::size_t i = 0; i < 2 * lengths.size(); ++i) {
        arc.push_back(arc.back() + lengths[i % lengths.size()]);
    }
    return arc;
}

/// The four corners, from `start` on: the vertices nearest to the quarter points, all different.
std::array<std::size_t, 4> quarter_points(const std::vector<double>& arc, std::size_t start) {
    std::array<std::size_t, 4> corners{start, 0, 0, 0};
    const std::size_t n = (arc.size() - 1) / 2;
    for (std::size_t q = 1; q < 4; ++q) {
        const double wanted = arc[start] + arc[n] * static_cast<double>(q) / 4.0;
        auto i = static_cast<std::size_t>(std::lower_bound(arc.begin(), arc.end(), wanted) -
                                          arc.begin());
        if (wanted - arc[i - 1] < arc[i] - wanted) --i;
        corners[q] = std::clamp(i, corners[q - 1] + 1, start + n - (4 - q));
    }
    return corners;
}

/// Sum of the 3D angles between the border's edges at the four corners.
double sharpness(const Region& region, const std::array<std::size_t, 4>& corners) {
    const std::size_t n = region.border.size();
    double sum = 0.0;
    for (const std::size_t corner : corners) {
        const std::size_t i = corner % n;
        sum += angle_at(region.position(region.border[i]),
                        region.position(region.border[(i + n - 1) % n]),
                        region.position(region.border[(i + 1) % n]));
    }
    return sum;
}

/// The exterior angle at each vertex of a counter-clockwise polygon.
std::vector<double> turning_angles(const Points2& polygon) {
    const std::size_t n = polygon.size();
    std::vector<double> turning;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 in = polygon[i] - polygon[(i + n - 1) % n],
                   out = polygon[(i + 1) % n] - polygon[i];
        turning.push_back(signed_angle(in, out));
    }
    return turning;
}

bool is_corner(double turning) {
    return turning > tolerance::corner;
}

/// Per vertex the corner at which the side that leaves it begins.
std::vector<std::size_t> sides(const std::vector<double>& turning) {
    const std::size_t n = turning.size();
    std::vector<std::size_t> side(n, 0);
    std::size_t corner = 0;
    for (std::size_t i = 0; i < 2 * n; ++i) {  // twice: the first ones belong to the last corner
        if (is_corner(turning[i % n])) corner = i % n;
        side[i % n] = corner;
    }
    return side;
}

/// Per corner, whether an edge inside the region has both ends on its side.
std::vector<bool> chorded_sides(const Region& region, const std::vector<std::size_t>& side_of) {
    const std::size_t n = region.border.size();
    const auto index = inverse(region.border, region.positions.size());
    std::vector<bool> chorded(n, false);
    for (const Triangle& t : region.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Index a = index[at(t[k])];
            const Index b = index[at(t[(k + 1) % 3])];
            if (a < 0 || b < 0) continue;
            const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
            if (j == (i + 1) % n || i == (j + 1) % n) continue;
            // The side's last vertex is the next corner, on which the next side begins.
            for (const auto& [from, to] : {std::pair(i, j), std::pair(j, i)}) {
                const std::size_t side = side_of[from];
                if (side_of[to] == side || side_of[(to + n - 1) % n] == side) chorded[side] = true;
            }
        }
    }
    return chorded;
}

}  // namespace

Points2 circle_border(const Region& region) {
    const auto arc = arc_lengths(border_lengths(region));
    const std::size_t n = region.border.size();
    const double radius = arc[n] / (2.0 * std::numbers::pi);
    Points2 points;
    for (std::size_t i = 0; i < n; ++i) {
        const double angle = arc[i] / radius;
        points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    return points;
}

Points2 square_border(const Region& region) {
    const std::size_t n = region.border.size();
    if (n < 4) throw Error(ErrorCode::method_failed, "a square border needs four border vertices");
    const auto arc = arc_lengths(border_lengths(region));
    std::size_t start = 0;
    double sharpest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
        const double sum = sharpness(region, quarter_points(arc, i));
        if (sum < sharpest) {
            sharpest = sum;
            start = i;
        }
    }
    const auto corners = quarter_points(arc, start);
    const double side = arc[n] / 4.0;
    const std::array<Vec2, 4> square{Vec2(0, 0), Vec2(side, 0), Vec2(side, side), Vec2(0, side)};
    Points2 points(n);
    for (std::size_t q = 0; q < 4; ++q) {
        const std::size_t first = corners[q], last = q < 3 ? corners[q + 1] : start + n;
        for (std::size_t i = first; i < last; ++i) {
            const double t = (arc[i] - arc[first]) / (arc[last] - arc[first]);
            points[i % n] = (1.0 - t) * square[q] + t * square[(q + 1) % 4];
        }
    }
    return points;
}

Points2 hull_border(const Points2& polygon) {
    auto hull = convex_hull(polygon);
    std::rotate(hull.begin(), std::min_element(hull.begin(), hull.end()), hull.end());
    if (hull.size() < 3 || !std::is_sorted(hull.begin(), hull.end())) {
        throw Error(ErrorCode::method_failed, "the flat border winds around itself");
    }
    const std::size_t n = polygon.size();
    Points2 points(n);
    for (std::size_t h = 0; h < hull.size(); ++h) {
        const auto first = static_cast<std::size_t>(hull[h]);
        const auto last = h + 1 < hull.size() ? static_cast<std::size_t>(hull[h + 1])
                                              : static_cast<std::size_t>(hull.front()) + n;
        double total = 0.0;
        for (std::size_t i = first; i < last; ++i)
            total += (polygon[(i + 1) % n] - polygon[i % n]).norm();
        double arc = 0.0;
        for (std::size_t i = first; i < last; ++i) {
            points[i % n] = polygon[first] + arc / total * (polygon[last % n] - polygon[first]);
            arc += (polygon[(i + 1) % n] - polygon[i % n]).norm();
        }
    }
    return points;
}

Points2 bulged_under_chords(const Region& region, Points2 convex) {
    const auto turning = turning_angles(convex);
    const auto side_of = sides(turning);
    const auto chorded = chorded_sides(region, side_of);
    const std::size_t n = convex.size();
    const Points2 straight = convex;
    for (std::size_t first = 0; first < n; ++first) {
        if (!is_corner(turning[first]) || !chorded[side_of[first]]) continue;
        std::size_t last = first + 1;
        while (!is_corner(turning[last % n])) ++last;
        const Vec2 along = straight[last % n] - straight[first];
        const Vec2 outward(along.y(), -along.x());
        // A parabola of slope 4 h at its ends: both corners stay convex.
        const double h = std::min({0.01, turning[first] / 8.0, turning[last % n] / 8.0});
        for (std::size_t i = first + 1; i < last; ++i) {
            const double t = (straight[i % n] - straight[first]).norm() / along.norm();
            convex[i % n] += 4.0 * h * t * (1.0 - t) * outward;
        }
    }
    return convex;
}

Points2 virtual_layer(const Points2& convex, double distance) {
    const std::size_t n = convex.size();
    Points2 layer;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 before = (convex[i] - convex[(i + n - 1) % n]).normalized();
        const Vec2 after = (convex[(i + 1) % n] - convex[i]).normalized();
        const Vec2 normal_before(before.y(), -before.x()), normal_after(after.y(), -after.x());
        // The point at `distance` from both edges: the mitre of the offset polygon.
        layer.push_back(convex[i] + distance / (1.0 + normal_before.dot(normal_after)) *
                                        (normal_before + normal_after));
    }
    return layer;
}

}  // namespace lastflat
