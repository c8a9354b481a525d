// The nearest point of the surface.
#pragma once

#include "core/locate/surface_point.h"
#include "core/numerics/triangle_search.h"

namespace lastflat {

class SurfaceSearch {
public:
    /// The surface must outlive the search and keep its faces.
    explicit SurfaceSearch(const SurfaceMesh& surface);

    struct Nearest {
        SurfacePoint point;
        Vec3 position;
        double distance;  ///< mm
    };
    [[nodiscard]] Nearest nearest(const Vec3& position) const;
    /// The diagonal of the box around the surface.
    [[nodiscard]] double size() const { return search_.size(); }

private:
    const SurfaceMesh& surface_;
    const TriangleSearch search_;
};

}  // namespace lastflat
