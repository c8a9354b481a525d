// glTF 2.0, as JSON text or as GLB.
#pragma once

#include <string_view>

#include "core/load/load_model.h"

namespace lastflat {

/// Reads the triangles (lists, strips, fans) and lines of the default scene. Positions may be
/// interleaved, unindexed, normalised or quantized (KHR_mesh_quantization); node transforms are
/// applied, and a mirroring one turns the winding; so are the weights of morph targets, and skins,
/// their joints at rest. Primitives of one node that share their accessors share the vertices.
/// Names of nodes (with their ancestors), meshes and materials are the groups. Images are never
/// decoded; no other file is ever opened.
///
/// Throws: Error{unreadable_model, unsupported_model, model_too_large, mesh_degenerate} naming the
///         extension, the file, the accessor or the node at fault.
[[nodiscard]] RawMesh read_gltf(std::string_view text, const LoadLimits& limits);
[[nodiscard]] RawMesh read_glb(std::string_view bytes, const LoadLimits& limits);

}  // namespace lastflat
