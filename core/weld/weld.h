// Triangles to a surface.
#pragma once

#include "core/load/raw_mesh.h"
#include "core/weld/surface_mesh.h"

namespace lastflat {

struct WeldOptions {
    std::optional<double> unit_mm;    ///< one unit of the model in mm; default: the format's
    std::vector<std::string> groups;  ///< faces that carry one of these names; empty: all faces
    /// Vertices at most this far apart become one. Default: only vertices of one and the same
    /// place, and only in models without indices, so that a slit stays a slit.
    std::optional<double> tolerance_mm;
};

/// Selects the faces, scales to mm, welds if asked, and checks that the result is a surface: every
/// edge has one or two faces that wind alike, every vertex one fan of faces, every face an area.
///
/// Out:    a closed model that is inside out is turned, with the warning `orientation_reversed`.
/// Throws: Error{group_not_found, mesh_not_manifold, mesh_not_oriented, mesh_degenerate,
///         model_too_large}, with the place in mm.
[[nodiscard]] SurfaceMesh weld(const RawMesh& raw, const WeldOptions& options = {});

}  // namespace lastflat
