// PLY (the Stanford polygon format).
#pragma once

#include <string_view>

#include "core/load/load_model.h"

namespace lastflat {

/// Reads the elements `vertex` (x, y, z) and `face` (vertex_indices or vertex_index), as text or
/// binary of either byte order; other properties and elements are passed over. Polygons are split
/// by ear clipping.
///
/// Throws: Error{unreadable_model, unsupported_model, model_too_large} naming the line or the
///         element.
[[nodiscard]] RawMesh read_ply(std::string_view bytes, const LoadLimits& limits);

}  // namespace lastflat
