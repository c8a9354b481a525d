// Triangles to a surface.
#pragma once

#include "core/load/raw_mesh.h"
#include "core/request.h"
#include "core/weld/surface_mesh.h"

namespace lastflat {

/// Selects the faces, scales to mm (the unit is guessed where nobody says), welds, mends what can
/// be mended, and checks that the result is a surface: every edge has one or two faces that wind
/// alike, every vertex one fan of faces, every face an area.
///
/// In:     `limits`: the vertices that may be left of a model without indices.
/// Out:    `repairs` says what was done: repeated and flat faces left out, faces turned, loose
///         pieces, fins and inner shells dropped, seams joined, borders stitched, vertices split
///         where the surface touched itself, small holes closed (by the rule `automatic`), a closed
///         model that was inside out turned. The warning `gaps_left` names what would close pieces.
/// Throws: Error{group_not_found, mesh_not_manifold, mesh_not_oriented (it has no two sides),
///         mesh_degenerate, model_too_large}, with the position in mm.
[[nodiscard]] SurfaceMesh weld(const RawMesh& raw, const WeldOptions& options = {},
                               HoleRule holes = HoleRule::automatic, const LoadLimits& limits = {});

}  // namespace lastflat
