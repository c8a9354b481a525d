// Bytes to triangles: one reader per format, chosen by content.
#pragma once

#include <span>
#include <string_view>

#include "core/load/raw_mesh.h"
#include "core/progress.h"
#include "core/request.h"

namespace lastflat {

/// Reads a model: Wavefront OBJ, STL, PLY, glTF 2.0 or binary glTF (GLB). The content decides the
/// format.
///
/// In:     the file's bytes; nothing outside them is ever opened.
/// Out:    positions in the model's unit, triangles, group names. Ids as in `RawMesh`.
///         A name that is not UTF-8 is read as Latin-1.
/// Throws: Error{unreadable_model, unsupported_model, model_too_large, mesh_degenerate}, naming the
///         line (text formats) or the accessor, node, extension or file (glTF).
[[nodiscard]] RawMesh load_model(std::string_view bytes, const LoadLimits& limits = {});

}  // namespace lastflat
