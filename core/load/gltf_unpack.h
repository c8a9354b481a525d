// Compressed glTF to plain glTF: EXT_meshopt_compression and KHR_draco_mesh_compression.
#pragma once

#include <string>
#include <string_view>

#include "core/load/load_model.h"

namespace lastflat {

/// Whether the glTF document requires one of the two extensions.
[[nodiscard]] bool is_packed_gltf(std::string_view json);

/// The same GLB with every compressed buffer view and primitive decoded, of these only positions
/// and triangles, and the extensions gone.
///
/// In:     a GLB that `guard_gltf` has passed, whose compressed bytes are in its own BIN chunk.
/// Throws: Error{unreadable_model, unsupported_model, model_too_large}.
[[nodiscard]] std::string unpack_glb(std::string_view glb, const LoadLimits& limits);

}  // namespace lastflat
