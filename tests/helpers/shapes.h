// Regions that tests make: shapes whose flattening is known.
#pragma once

#include <cmath>
#include <functional>
#include <string>

#include "core/cut/find_border.h"
#include "core/cut/region.h"

namespace lastflat::test {

/// A grid of columns x rows cells over [0,1]^2, bent by `shape`. Diagonals alternate, so that no
/// direction is preferred. Curves: "bottom", "right", "top", "left", each along its border side.
inline Region grid(int columns, int rows, const std::function<Vec3(double, double)>& shape) {
    Region region;
    region.name = "grid";
    const auto id = [&](int i, int j) { return static_cast<Index>(j * (columns + 1) + i); };
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            region.positions.push_back(
                shape(static_cast<double>(i) / columns, static_cast<double>(j) / rows));
            region.source_vertices.push_back(id(i, j));
        }
    }
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const Index a = id(i, j), b = id(i + 1, j), c = id(i + 1, j + 1), d = id(i, j + 1);
            if ((i + j) % 2 == 0) {
                region.triangles.push_back({a, b, c});
                region.triangles.push_back({a, c, d});
            } else {
                region.triangles.push_back({a, b, d});
                region.triangles.push_back({b, c, d});
            }
        }
    }
    region.runs = {{"bottom", {}}, {"right", {}}, {"top", {}}, {"left", {}}};
    for (int i = 0; i <= columns; ++i) {
        region.runs[0].vertices.push_back(id(i, 0));
        region.runs[2].vertices.push_back(id(i, rows));
    }
    for (int j = 0; j <= rows; ++j) {
        region.runs[1].vertices.push_back(id(columns, j));
        region.runs[3].vertices.push_back(id(0, j));
    }
    find_border(region);
    return region;
}

/// A plane whose grid is uneven, so that weights differ from vertex to vertex.
inline Region plane(int n = 8) {
    return grid(n, n, [](double s, double t) {
        return Vec3(90 * s + 9 * std::sin(3 * t) * s * (1 - s),
                    60 * t + 8 * std::sin(4 * s) * t * (1 - t), 0);
    });
}

/// A quarter of a cylinder: developable.
inline Region cylinder(int n = 12) {
    return grid(n, n, [](double s, double t) {
        const double angle = 1.5 * s;
        return Vec3(40 * std::sin(angle), 70 * t, 40 * (1 - std::cos(angle)));
    });
}

/// A patch of a cone: developable.
inline Region cone(int n = 12) {
    return grid(n, n, [](double s, double t) {
        const double r = 50 + 60 * t, half = 0.4, turn = 1.2 * s / std::sin(half);
        return Vec3(r * std::sin(half) * std::cos(turn), r * std::sin(half) * std::sin(turn),
                    -r * std::cos(half));
    });
}

/// A patch of a sphere: not developable.
inline Region dome(int n = 12, double angle = 0.6) {
    return grid(n, n, [angle](double s, double t) {
        const double a = angle * (2 * s - 1), b = angle * (2 * t - 1);
        return Vec3(60 * std::sin(a), 60 * std::cos(a) * std::sin(b),
                    60 * std::cos(a) * std::cos(b));
    });
}

/// A saddle with a wave: not developable, and without symmetry.
inline Region saddle(int n = 12) {
    return grid(n, n, [](double s, double t) {
        return Vec3(80 * s, 60 * t, 14 * (s - 0.5) * (t - 0.4) + 5 * std::sin(4 * s + 2 * t));
    });
}

/// A ramp that turns more than once: flat, its ends would lie on each other.
inline Region spiral(double turns = 1.3, int n = 60) {
    return grid(n, 3, [turns](double s, double t) {
        const double angle = 2.0 * M_PI * turns * s, r = 60 - 20 * t;
        return Vec3(r * std::cos(angle), r * std::sin(angle), 10 * turns * s);
    });
}

/// The largest difference between two sets of points after the best rigid motion in the plane.
inline double rigid_difference(const Points2& a, const Points2& b) {
    Vec2 mean_a = Vec2::Zero(), mean_b = Vec2::Zero();
    for (std::size_t i = 0; i < a.size(); ++i) {
        mean_a += a[i] / static_cast<double>(a.size());
        mean_b += b[i] / static_cast<double>(a.size());
    }
    double c = 0, s = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Vec2 p = a[i] - mean_a, q = b[i] - mean_b;
        c += p.dot(q);
        s += p.x() * q.y() - p.y() * q.x();
    }
    const double angle = std::atan2(s, c);
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Vec2 p = a[i] - mean_a, q = b[i] - mean_b;
        const Vec2 turned(std::cos(angle) * p.x() - std::sin(angle) * p.y(),
                          std::sin(angle) * p.x() + std::cos(angle) * p.y());
        largest = std::max(largest, (turned - q).norm());
    }
    return largest;
}

/// The largest relative change of an edge's length.
inline double worst_edge_change(const Region& region, const Points2& uv) {
    double worst = 0;
    for (const Triangle& t : region.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Index a = t[i], b = t[(i + 1) % 3];
            const double flat =
                (uv[static_cast<std::size_t>(a)] - uv[static_cast<std::size_t>(b)]).norm();
            worst = std::max(worst, std::abs(flat / region.distance(a, b) - 1));
        }
    }
    return worst;
}

}  // namespace lastflat::test
