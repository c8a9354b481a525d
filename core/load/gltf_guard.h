// What glTF text must be before a general reader may see it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/load/load_model.h"

namespace lastflat {

/// Refuses nesting deeper than the limit, files outside the model, numbers of sparse accessors that
/// a general reader would cut to 32 bits, and required extensions that may change the triangles,
/// each by name. `json`: the glTF document (for GLB its JSON chunk).
///
/// Out:    the document to read in its place, if it has strings that are not UTF-8 (they are read
///         as Latin-1) or images (they are left out: of any type, they change no triangle).
/// Throws: Error{unreadable_model, unsupported_model}.
[[nodiscard]] std::optional<std::string> guard_gltf(std::string_view json,
                                                    const LoadLimits& limits);

/// The JSON chunk of a GLB container.
/// Throws: Error{unreadable_model} if the container's lengths do not fit its bytes.
[[nodiscard]] std::string_view json_chunk(std::string_view glb);

/// The container with another document in its JSON chunk.
[[nodiscard]] std::string with_json_chunk(std::string_view glb, std::string json);

}  // namespace lastflat
