// The methods that a request may name.
#pragma once

#include "core/border/border_angles.h"

namespace lastflat {

enum class MethodName {
    tutte,
    chord_length,
    shape_preserving,
    harmonic,
    wachspress,
    mean_value,
    virtual_border,
    geodesic_fan,
    mips,
    green_lagrange,
    isometric
};
enum class BorderShape { square, circle, hull, floating };

struct MethodOptions {
    MethodName name = MethodName::isometric;
    BorderShape border = BorderShape::circle;  ///< of the methods from tutte to mean_value
    AngleRule angles = AngleRule::curvature;   ///< of the border's polygon
};

/// Whether the method minimises an energy: its start is the geodesic fan.
[[nodiscard]] constexpr bool is_energy(MethodName name) {
    return name == MethodName::mips || name == MethodName::green_lagrange ||
           name == MethodName::isometric;
}

}  // namespace lastflat
