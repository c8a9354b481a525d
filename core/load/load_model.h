// Bytes to triangles: one reader per format, chosen by content.
#pragma once

#include <span>
#include <string_view>

#include "core/load/raw_mesh.h"
#include "core/progress.h"

namespace lastflat {

/// What a model may be at most. Every reader checks before it allocates.
struct LoadLimits {
    std::size_t vertices = 4'000'000;
    std::size_t triangles = 4'000'000;
    std::size_t polygon_corners = 1024;  ///< of one OBJ face
    std::size_t name_bytes = 256;        ///< of one group name
    std::size_t face_names = 64;         ///< of one face
    std::size_t name_sets = 4096;        ///< different sets of names
    std::size_t lines = 4096;            ///< polylines
    std::size_t json_depth = 64;         ///< nesting inside glTF
};

/// Reads a model: Wavefront OBJ, STL, PLY, glTF 2.0 or binary glTF (GLB). The content decides the
/// format.
///
/// In:     the file's bytes; nothing outside them is ever opened.
/// Out:    positions in the model's unit, triangles, group names. Ids as in `RawMesh`.
/// Throws: Error{unreadable_model, unsupported_model, model_too_large, mesh_degenerate}, naming the
///         line (text formats) or the accessor, node, extension or file (glTF).
[[nodiscard]] RawMesh load_model(std::string_view bytes, const LoadLimits& limits = {});

}  // namespace lastflat
