// The nearest place of the surface.
#pragma once

#include <memory>

#include "core/locate/surface_place.h"
#include "core/numerics/box_tree.h"

namespace lastflat {

class SurfaceSearch {
public:
    /// The surface must outlive the search and keep its faces.
    explicit SurfaceSearch(const SurfaceMesh& surface);

    struct Nearest {
        SurfacePlace place;
        Index face;
        Vec3 position;
        double distance;  ///< mm
    };
    [[nodiscard]] Nearest nearest(const Vec3& position) const;

private:
    const SurfaceMesh& surface_;
    std::vector<Index> faces_;  ///< in an order in which neighbours are near
    std::unique_ptr<const BoxTree<Box3>> tree_;
    double size_ = 0.0;
};

/// The weights of the triangle's place nearest to a point; exactly 0 where it is on the border.
[[nodiscard]] Vec3 nearest_weights(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point);

}  // namespace lastflat
