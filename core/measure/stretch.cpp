// Based on: Sander, Snyder, Gortler, Hoppe, "Texture Mapping Progressive Meshes", SIGGRAPH 2001.
#include "core/measure/stretch.h"

#include <cmath>

#include "core/numerics/geometry.h"

namespace lastflat {

Stretch stretch_of(const Region& region, const Points2& uv, const Triangle& t) {
    const Vec3 &q1 = region.position(t[0]), &q2 = region.position(t[1]),
               &q3 = region.position(t[2]);
    const Vec2 &p1 = uv[static_cast<std::size_t>(t[0])], &p2 = uv[static_cast<std::size_t>(t[1])],
               &p3 = uv[static_cast<std::size_t>(t[2])];
    const double doubled = doubled_area(p1, p2, p3);
    const Vec3 S_s =
        (q1 * (p2.y() - p3.y()) + q2 * (p3.y() - p1.y()) + q3 * (p1.y() - p2.y())) / doubled;
    const Vec3 S_t =
        (q1 * (p3.x() - p2.x()) + q2 * (p1.x() - p3.x()) + q3 * (p2.x() - p1.x())) / doubled;
    const double a = S_s.dot(S_s), b = S_s.dot(S_t), c = S_t.dot(S_t);
    const double root = std::sqrt((a - c) * (a - c) + 4.0 * b * b);
    const double area_3d = 0.5 * doubled_area_vector(region, t).norm();
    const double G = std::sqrt(0.5 * (a + c + root));
    // G g is the ratio of the areas; subtracting root instead would cancel.
    return {G, 2.0 * area_3d / std::abs(doubled) / G, area_3d, 0.5 * doubled};
}

}  // namespace lastflat
