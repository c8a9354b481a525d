// PLY (the Stanford polygon format).
#pragma once

#include <string_view>

#include "core/load/load_model.h"

namespace lastflat {

/// Reads the elements `vertex` (x, y, z), `face` and `tristrips` (vertex_indices or vertex_index;
/// -1 between strips), as text or binary of either byte order; other properties and elements are
/// passed over. Polygons are split by ear clipping. What follows the last element is passed over,
/// with the warning `trailing_bytes`; what follows the last value on a line of text is refused.
///
/// Throws: Error{unreadable_model, unsupported_model, model_too_large, mesh_degenerate}, naming the
///         line of a text.
[[nodiscard]] RawMesh read_ply(std::string_view bytes, const LoadLimits& limits);

}  // namespace lastflat
