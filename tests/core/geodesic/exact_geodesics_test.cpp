#include "core/geodesic/exact_geodesics.h"

#include <doctest/doctest.h>

#include "core/geodesic/trace_path.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

double at(const GeodesicDistances& distances, Index v) {
    return distances.distance[static_cast<std::size_t>(v)];
}

double length_of(const Region& region, const GeodesicPath& path) {
    double length = 0;
    for (std::size_t i = 1; i < path.points.size(); ++i) {
        length += (position_of(path.points[i], region.positions) -
                   position_of(path.points[i - 1], region.positions))
                      .norm();
    }
    return length;
}

/// A flat L: a 20 x 20 square without its upper right quarter, whose corner (10, 10) stays.
Region flat_l() {
    Region region = test::grid(20, 20, [](double s, double t) { return Vec3(20 * s, 20 * t, 0); });
    std::erase_if(region.triangles, [&](const Triangle& t) {
        const Vec3 mean =
            (region.position(t[0]) + region.position(t[1]) + region.position(t[2])) / 3;
        return mean.x() > 10 && mean.y() > 10;
    });
    std::vector<Index> id(region.positions.size(), -1);
    Points3 used;
    for (Triangle& t : region.triangles) {
        for (Index& v : t) {
            Index& known = id[static_cast<std::size_t>(v)];
            if (known < 0) {
                known = static_cast<Index>(used.size());
                used.push_back(region.position(v));
            }
            v = known;
        }
    }
    region.positions = used;
    region.runs.clear();
    find_border(region);
    return region;
}

}  // namespace

TEST_SUITE("core/geodesic/exact_geodesics") {
    TEST_CASE("on a plane distances are straight lines, whatever the triangles") {
        for (const Region& region : {test::plane(15), test::grid(9, 7, [](double s, double t) {
                                         return Vec3(90 * s, 60 * t, 0);
                                     })}) {
            const ExactGeodesics geodesics(region);
            const Index source = 40;
            const auto distances = geodesics.from_vertex(source, Progress());
            for (Index v = 0; v < static_cast<Index>(region.positions.size()); ++v) {
                CHECK(std::abs(at(distances, v) - region.distance(v, source)) < 1e-10);
            }
        }
    }

    TEST_CASE("a shortest path bends around a corner of the border") {
        const Region region = flat_l();
        const ExactGeodesics geodesics(region);
        for (const Vec3& start : {Vec3(19, 3, 0), Vec3(3, 19, 0)}) {
            Index source = -1;
            for (Index v = 0; v < static_cast<Index>(region.positions.size()); ++v) {
                if ((region.position(v) - start).norm() < 1e-9) source = v;
            }
            REQUIRE(source >= 0);
            const auto distances = geodesics.from_vertex(source, Progress());
            const Vec3 corner(10, 10, 0), from = region.position(source);
            for (Index v = 0; v < static_cast<Index>(region.positions.size()); ++v) {
                const Vec3 p = region.position(v);
                const double turn =
                    (corner - from).x() * (p - corner).y() - (corner - from).y() * (p - corner).x();
                const bool hidden =
                    start.y() < 10 ? p.y() > 10 && turn < 0 : p.x() > 10 && turn > 0;
                const double expected =
                    hidden ? (corner - from).norm() + (p - corner).norm() : (p - from).norm();
                CAPTURE(p.transpose());
                CHECK(std::abs(at(distances, v) - expected) < 1e-10);
                CHECK(std::abs(length_of(region, trace_path(geodesics.unfolding(), distances, v)) -
                               expected) < 1e-10);
            }
        }
    }

    TEST_CASE("developable patches have the distances of their unrolled shapes") {
        const Region region = test::cylinder(20);
        const auto flat = [&](Index v) {
            const Vec3& p = region.position(v);
            return Vec2(std::atan2(p.x(), 40 - p.z()), p.y());
        };
        // The chords of the polygon that stands for the circle, not its arcs.
        const double chord = 2 * 40 * std::sin(1.5 / 20 / 2) / (1.5 / 20);
        const ExactGeodesics geodesics(region);
        const auto distances = geodesics.from_vertex(110, Progress());
        for (Index v = 0; v < static_cast<Index>(region.positions.size()); ++v) {
            const Vec2 d = flat(v) - flat(110);
            CHECK(at(distances, v) ==
                  doctest::Approx(std::hypot(chord * d.x(), d.y())).epsilon(1e-12));
        }
    }

    TEST_CASE(
        "distances are the same both ways, and no path is longer than one over another vertex") {
        const Region region = test::saddle(14);
        const ExactGeodesics geodesics(region);
        const auto n = static_cast<Index>(region.positions.size());
        std::vector<GeodesicDistances> all;
        for (Index v = 0; v < n; ++v) all.push_back(geodesics.from_vertex(v, Progress()));
        double asymmetry = 0, excess = 0;
        for (Index a = 0; a < n; ++a) {
            for (Index b = 0; b < n; ++b) {
                const auto& from_a = all[static_cast<std::size_t>(a)];
                asymmetry = std::max(
                    asymmetry, std::abs(at(from_a, b) - at(all[static_cast<std::size_t>(b)], a)));
                for (Index via = 0; via < n; via += 7) {
                    excess = std::max(excess, at(from_a, b) - at(from_a, via) -
                                                  at(all[static_cast<std::size_t>(via)], b));
                }
            }
        }
        CHECK(asymmetry < 1e-10);
        CHECK(excess < 1e-10);
    }

    TEST_CASE("a path is as long as its distance") {
        for (const Region& region : {test::dome(16, 1.3), test::saddle(17), test::cone(11)}) {
            const ExactGeodesics geodesics(region);
            const auto distances = geodesics.from_vertex(30, Progress());
            for (Index v = 0; v < static_cast<Index>(region.positions.size()); ++v) {
                const auto path = trace_path(geodesics.unfolding(), distances, v);
                CHECK(path.points.front().a == 30);
                CHECK(path.points.back().a == v);
                CHECK(std::abs(length_of(region, path) - at(distances, v)) < 1e-10);
            }
        }
    }

    TEST_CASE("a row of saddles, each too flat to bend a path, hides no vertex") {
        const Region region = test::grid(
            40, 40, [](double u, double v) { return Vec3(40 * u, 40 * v, 2e-6 * 1600 * u * v); });
        const ExactGeodesics geodesics(region);
        for (const Index source : {Index{0}, Index{820}}) {
            try {
                for (const double d : geodesics.from_vertex(source, Progress()).distance)
                    CHECK(std::isfinite(d));
            } catch (const Error& error) {
                CHECK(error.code() == ErrorCode::solver_failed);
            }
        }
    }

    TEST_CASE("a surface that takes too many windows is given up") {
        const Region region = test::dome(30, 1.2);
        CHECK_THROWS_AS((void)ExactGeodesics(region, 1).from_vertex(400, Progress()), Error);
        CHECK_NOTHROW((void)ExactGeodesics(region).from_vertex(400, Progress()));
    }

    TEST_CASE("a canceled run stops") {
        Progress progress;
        progress.cancel();
        const Region region = test::dome(40, 1.0);
        CHECK_THROWS_AS((void)ExactGeodesics(region).from_vertex(0, progress), Error);
    }
}

}  // namespace lastflat
