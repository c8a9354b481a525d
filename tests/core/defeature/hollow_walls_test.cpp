#include <doctest/doctest.h>

#include <cmath>

#include "core/defeature/defeature.h"
#include "core/weld/weld.h"

namespace lastflat {
namespace {

/// A plate of 600 x 80 x 600 mm with a round hole through it: its walls are two triangles each, as
/// long as the hole is deep.
RawMesh plate_with_round_hole(double radius) {
    constexpr Index n = 24;
    RawMesh mesh;
    const auto ring = [&](double y, const auto& point) {
        for (Index i = 0; i < n; ++i) {
            const double angle = 2.0 * M_PI * (i + 0.5) / n;
            const Vec2 p = point(Vec2(std::cos(angle), std::sin(angle)));
            mesh.positions.emplace_back(p.x(), y, p.y());
        }
    };
    const auto square = [](double half) {
        return [half](const Vec2& way) { return Vec2(half / way.cwiseAbs().maxCoeff() * way); };
    };
    const auto hole = [&](const Vec2& way) { return Vec2(radius * way); };
    ring(0.0, square(300.0));
    ring(0.0, square(60.0));
    ring(0.0, hole);
    ring(80.0, hole);
    ring(80.0, square(60.0));
    ring(80.0, square(300.0));
    for (Index k = 0; k < 6; ++k) {
        for (Index i = 0; i < n; ++i) {
            const Index a = k * n + i, b = k * n + (i + 1) % n;
            const Index c = (a + n) % (6 * n), d = (b + n) % (6 * n);
            mesh.triangles.push_back({a, b, d});
            mesh.triangles.push_back({a, d, c});
        }
    }
    mesh.label_sets = {{}};
    mesh.triangle_labels.assign(mesh.triangles.size(), 0);
    return mesh;
}

}  // namespace

TEST_SUITE("core/defeature/hollow_walls") {
    TEST_CASE("the walls of a deep hole may be as long as it is, each mouth as wide as a feature") {
        for (const double radius : {3.0, 5.0, 7.0, 7.6}) {
            CAPTURE(radius);
            SurfaceMesh surface = weld(plate_with_round_hole(radius));
            Request fill;
            fill.cut.features = FeatureRule::fill;
            defeature(surface, fill);
            CHECK(surface.filled.size() == (radius < 7.5 ? 2 : 0));
        }
    }
}

}  // namespace lastflat
