// Wavefront OBJ.
#pragma once

#include <string_view>

#include "core/load/load_model.h"

namespace lastflat {

/// Reads `v`, `f`, `l`, `g`, `o` and `usemtl`; texture, normals and points are passed over, and
/// no material library is opened. Lines end with LF, CR LF or CR. Polygons are split by ear
/// clipping, so concave ones keep their shape. Indices may be negative (relative) as the format
/// allows.
///
/// Throws: Error{unreadable_model, unsupported_model, model_too_large} naming the line.
[[nodiscard]] RawMesh read_obj(std::string_view text, const LoadLimits& limits);

}  // namespace lastflat
