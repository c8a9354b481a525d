// Models that tests make: sheets and tubes of cells, some left out.
#pragma once

#include <cmath>
#include <functional>
#include <string>

#include "core/numerics/types.h"

namespace lastflat::test {

/// A grid of columns x rows cells as OBJ; vertex (i, j) is j * (columns + 1) + i, at shape(i, j).
inline std::string sheet_obj(int columns, int rows, const std::function<Vec3(int, int)>& shape,
                             const std::function<bool(int, int)>& is_hole = {}) {
    std::string obj;
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            const Vec3 p = shape(i, j);
            obj += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " +
                   std::to_string(p.z()) + "\n";
        }
    }
    const auto id = [&](int i, int j) { return std::to_string(j * (columns + 1) + i + 1) + " "; };
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            if (is_hole && is_hole(i, j)) continue;
            obj += "f " + id(i, j) + id(i + 1, j) + id(i + 1, j + 1) + id(i, j + 1) + "\n";
        }
    }
    return obj;
}

inline Vec3 flat(int i, int j) {
    return {10.0 * i, 10.0 * j, 0.0};
}

/// Bent both ways: not developable.
inline Vec3 bent(int i, int j) {
    return {10.0 * i, 10.0 * j, 0.02 * i * j * j - 0.3 * i * i + 3.0 * std::sin(0.4 * j)};
}

/// A tube of `around` columns and `up` rows of cells, open at both ends; vertex (i, j) is
/// j * around + i. Its shape: the place at an angle and a height.
inline std::string tube_obj(int around, int up, const std::function<Vec3(double, int)>& shape) {
    std::string obj;
    for (int j = 0; j <= up; ++j) {
        for (int i = 0; i < around; ++i) {
            const Vec3 p = shape(2 * M_PI * i / around, j);
            obj += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " +
                   std::to_string(p.z()) + "\n";
        }
    }
    for (int j = 0; j < up; ++j) {
        for (int i = 0; i < around; ++i) {
            const int a = j * around + i + 1, b = j * around + (i + 1) % around + 1;
            obj += "f " + std::to_string(a) + " " + std::to_string(b) + " " +
                   std::to_string(b + around) + " " + std::to_string(a + around) + "\n";
        }
    }
    return obj;
}

inline std::string tube_obj(int around, int up) {
    return tube_obj(around, up,
                    [](double angle, int j) { return Vec3(std::cos(angle), std::sin(angle), j); });
}

}  // namespace lastflat::test
