// What glTF text must be before a general reader may see it.
#pragma once

#include <string_view>

#include "core/load/load_model.h"

namespace lastflat {

/// Refuses nesting deeper than the limit, files outside the model, and required extensions that
/// are not read, each by name. `json`: the glTF document (for GLB its JSON chunk).
/// Throws: Error{unreadable_model, unsupported_model}.
void guard_gltf(std::string_view json, const LoadLimits& limits);

/// The JSON chunk of a GLB container.
/// Throws: Error{unreadable_model} if the container's lengths do not fit its bytes.
[[nodiscard]] std::string_view json_chunk(std::string_view glb);

}  // namespace lastflat
