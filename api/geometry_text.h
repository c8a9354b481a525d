// The parts of a result that grow with the mesh.
#pragma once

#include <string>

#include "core/result.h"

namespace lastflat::api {

/// Members of a region's object: `uv_mm`, `triangles`, the ways back to the model, outlines.
[[nodiscard]] std::string geometry_text(const FlatRegion& flat, const SourceIds& sources);

/// The member `model`: what the ids of all regions refer to.
[[nodiscard]] std::string model_text(const FlattenResult& result);

}  // namespace lastflat::api
