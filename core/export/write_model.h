// Meshes as files.
#pragma once

#include <string>

#include "core/load/raw_mesh.h"
#include "core/result.h"

namespace lastflat {

/// OBJ of the flattened regions: per region a `g`, its vertices in space (`v`, mm) and flat (`vt`,
/// mm, in the region's own coordinates).
[[nodiscard]] std::string write_flat_obj(const FlattenResult& result);

/// GLB of the flattened regions, one node, mesh and primitive each, named as the region. POSITION
/// in metres, y up as given; TEXCOORD_0 in mm on the sheet, v upward, so one texture of the sheet's
/// size
/// (`extras.sheet_mm` of the scene) covers all pieces without overlap.
[[nodiscard]] std::string write_flat_glb(const FlattenResult& result);

/// OBJ of a model with its groups, mm, four decimals.
[[nodiscard]] std::string write_model_obj(const RawMesh& mesh);

/// GLB of a model, one primitive per group, all sharing one POSITION accessor; metres.
[[nodiscard]] std::string write_model_glb(const RawMesh& mesh);

}  // namespace lastflat
