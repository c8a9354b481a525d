// Named curves on the surface.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/weld/surface_mesh.h"

namespace lastflat {

/// What the request says of a curve.
struct CurveSource {
    std::string name;
    std::vector<Index> vertices;  ///< ids of the file
};

/// A path along edges of the surface; closed if the first vertex is also the last.
struct Curve {
    std::string name;
    std::vector<Index> vertices;
    [[nodiscard]] bool closed() const { return vertices.front() == vertices.back(); }
};

using Curves = std::vector<Curve>;

/// Finds every curve on the surface.
///
/// Throws: Error{curve_invalid} naming the curve, the item and the place, if an id does not exist
///         or is not on the selected faces, if two consecutive vertices share no edge, or if the
///         path meets itself other than by closing.
[[nodiscard]] Curves locate_curves(const SurfaceMesh& surface,
                                   const std::vector<CurveSource>& sources);

}  // namespace lastflat
