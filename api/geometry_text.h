// The parts of a result that grow with the mesh.
#pragma once

#include <string>

#include "core/result.h"

namespace lastflat::api {

/// Members of a region's object: `triangles` and the ways back to the model.
[[nodiscard]] std::string mesh_text(const FlatRegion& flat, const SourceIds& sources);

/// Its `uv_mm`; its outlines.
[[nodiscard]] std::string chart_text(const FlatRegion& flat);
[[nodiscard]] std::string outline_text(const FlatRegion& flat);

/// Coordinates as lists in a list, in text.
[[nodiscard]] std::string coordinates_text(const Points2& points);
[[nodiscard]] std::string coordinates_text(const Points3& points);

/// The member `model`: what the ids of all regions refer to.
[[nodiscard]] std::string model_text(const FlattenResult& result);

}  // namespace lastflat::api
