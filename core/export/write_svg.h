// The pattern as a drawing.
#pragma once

#include <string>

#include "core/result.h"

namespace lastflat {

/// SVG in millimetres (one user unit is 1 mm, so it prints 1:1): per region a group named after it
/// with the strain of the leather as colour (see `StrainColours`) and its worst place, the outline,
/// each named curve with its length on the last and in the flat, and the geodesic fan if it is to
/// be drawn; below them a scale bar and the key to the colours. Lines, text and marks are in
/// proportion to the sheet; text that would not fit legibly is shortened, or left out.
[[nodiscard]] std::string write_svg(const FlattenResult& result);

}  // namespace lastflat
