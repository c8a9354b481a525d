// Compressed glTF to plain glTF: EXT_meshopt_compression and KHR_draco_mesh_compression.
#pragma once

#include <string>
#include <string_view>

#include "core/load/load_model.h"

namespace lastflat {

/// Whether the glTF document requires one of the two extensions.
[[nodiscard]] bool is_packed_gltf(std::string_view json);

/// A GLB with every compressed buffer view and primitive decoded, of these only positions and
/// triangles, the extensions gone, and all buffers joined to its own.
///
/// In:     a GLB, or a glTF document, that `guard_gltf` has passed: its buffers are data URIs or
/// the
///         GLB's own.
/// Throws: Error{unreadable_model, unsupported_model, model_too_large}.
[[nodiscard]] std::string unpack_glb(std::string_view glb, const LoadLimits& limits);
[[nodiscard]] std::string unpack_gltf(std::string_view json, const LoadLimits& limits);

}  // namespace lastflat
