// The pattern as a drawing.
#pragma once

#include <string>

#include "core/result.h"

namespace lastflat {

/// SVG in millimetres (one user unit is 1 mm, so it prints 1:1): per region a group named after it
/// with the stretch as colour, the outline, and each named curve with its length on the last and in
/// the flat, and the geodesic fan if it is to be drawn; below them a scale bar and the key to the
/// colours.
[[nodiscard]] std::string write_svg(const FlattenResult& result);

}  // namespace lastflat
