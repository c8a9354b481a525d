// Shapes as CAD programs make them, whose geodesic distances are known.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>

#include "core/numerics/types.h"

namespace lastflat::test {

/// As a file with so many digits has it.
inline double rounded(double x, int digits) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.*g", digits, x);
    return std::strtod(text.data(), nullptr);
}

/// Rings of vertices, each joined to the next by triangles; ring k begins at vertex k * columns.
enum class Diagonals { alike, alternating };
inline Triangulation tube(int columns, int rows, Diagonals diagonals,
                          const std::function<Vec3(int, int)>& place) {
    Triangulation tube;
    for (int k = 0; k <= rows; ++k) {
        for (int i = 0; i < columns; ++i) tube.positions.push_back(place(i, k));
    }
    for (int k = 0; k < rows; ++k) {
        for (int i = 0; i < columns; ++i) {
            const Index a = k * columns + i, b = k * columns + (i + 1) % columns;
            const Index c = a + columns, d = b + columns;
            if (diagonals == Diagonals::alternating && (i + k) % 2 == 1) {
                tube.triangles.push_back({a, b, c});
                tube.triangles.push_back({b, d, c});
            } else {
                tube.triangles.push_back({a, b, d});
                tube.triangles.push_back({a, d, c});
            }
        }
    }
    return tube;
}

/// Triangles around vertex 0, at 1 from it, with `angle` at it, in a zigzag that closes around it.
inline Triangulation zigzag_fan(int n, double angle) {
    Triangulation fan;
    fan.positions.push_back(Vec3::Zero());
    // Neighbours are `turn` apart in longitude and lie as far above the equator as below.
    const double turn = 2.0 * std::numbers::pi / n;
    const double square = (std::cos(turn) - std::cos(angle)) / (1.0 + std::cos(turn));
    const double up = std::sqrt(square), out = std::sqrt(1.0 - square);
    for (int i = 0; i < n; ++i) {
        fan.positions.emplace_back(out * std::cos(i * turn), out * std::sin(i * turn),
                                   i % 2 == 0 ? up : -up);
        fan.triangles.push_back({0, i + 1, (i + 1) % n + 1});
    }
    return fan;
}

/// A strip in the plane with teeth of width 1 and height `height` on it, 1 apart.
inline Triangulation comb(int teeth, double height) {
    Triangulation comb;
    for (int i = 0; i < 2 * teeth; ++i) {
        comb.positions.emplace_back(i, 0, 0);
        comb.positions.emplace_back(i, 5, 0);
        const Index a = 2 * i, c = 2 * i - 1, d = 2 * i + 1;
        if (i == 0) continue;
        comb.triangles.push_back({a - 2, a, d});
        comb.triangles.push_back({a - 2, d, c});
    }
    for (int i = 0; i < 2 * teeth; i += 2) {
        const auto tip = static_cast<Index>(comb.positions.size());
        comb.positions.emplace_back(i, 5 + height, 0);
        comb.positions.emplace_back(i + 1, 5 + height, 0);
        comb.triangles.push_back({2 * i + 1, 2 * i + 3, tip + 1});
        comb.triangles.push_back({2 * i + 1, tip + 1, tip});
    }
    return comb;
}

}  // namespace lastflat::test
