// The nearest point of triangles.
#pragma once

#include "core/numerics/box_tree.h"

namespace lastflat {

/// The weights of the point of the triangle nearest to a point; exactly 0 where it is on the
/// border.
[[nodiscard]] Vec3 nearest_weights(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point);

class TriangleSearch {
public:
    explicit TriangleSearch(const Triangulation& surface);

    struct Nearest {
        Index triangle = -1;
        Vec3 weights;  ///< of its corners
        Vec3 position;
        double distance;
    };
    [[nodiscard]] Nearest nearest(const Vec3& position) const;
    [[nodiscard]] double size() const { return size_; }

private:
    struct Order {
        std::vector<Index> triangles;  ///< in an order in which neighbours are near
        std::vector<Box3> boxes;
        double size;
    };
    static Order order_of(const Triangulation& surface);
    TriangleSearch(const Triangulation& surface, Order order);

    const Triangulation surface_;
    const std::vector<Index> triangles_;
    const BoxTree<Box3> tree_;
    const double size_;
};

}  // namespace lastflat
