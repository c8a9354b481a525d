// Meshes as files.
#pragma once

#include <string>

#include "core/load/raw_mesh.h"
#include "core/result.h"

namespace lastflat {

/// OBJ of the flattened regions: per region a `g`, its vertices in space (`v`, mm) and flat (`vt`,
/// mm, in the region's own coordinates).
[[nodiscard]] std::string write_flat_obj(const FlattenResult& result);

/// OBJ of a model with its groups, mm, four decimals.
[[nodiscard]] std::string write_model_obj(const RawMesh& mesh);

/// GLB of a model, one primitive per group, all sharing one POSITION accessor; metres.
[[nodiscard]] std::string write_model_glb(const RawMesh& mesh);

}  // namespace lastflat
