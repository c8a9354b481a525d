// Draco-compressed triangles (KHR_draco_mesh_compression).
#pragma once

#include <string_view>

#include "core/load/load_model.h"

namespace lastflat {

struct DracoTriangles {
    Points3 positions;
    std::vector<Index> corners;  ///< three a triangle
};

/// Decodes one mesh. `attribute`: the unique id of its positions.
/// Throws: Error{unreadable_model, model_too_large}.
[[nodiscard]] DracoTriangles decode_draco(std::string_view bytes, int attribute,
                                          const LoadLimits& limits);

}  // namespace lastflat
