// The methods that a request may name.
#pragma once

#include "core/border/border_angles.h"

namespace lastflat {

enum class MethodName { mean_value, geodesic_fan, isometric };
enum class BorderShape { circle, square };

struct MethodOptions {
    MethodName name = MethodName::isometric;
    BorderShape border = BorderShape::circle;  ///< of mean_value
    AngleRule angles = AngleRule::curvature;   ///< of geodesic_fan
};

}  // namespace lastflat
