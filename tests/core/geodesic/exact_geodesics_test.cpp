#include "core/geodesic/exact_geodesics.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/geodesic/trace_path.h"
#include "tests/helpers/cad_shapes.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

double at(const GeodesicDistances& distances, Index v) {
    return distances.distance[static_cast<std::size_t>(v)];
}

double length_of(const Triangulation& region, const GeodesicPath& path) {
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

using std::numbers::pi;
using test::Diagonals, test::rounded, test::tube;

constexpr std::array all_digits{4, 6, 7, 9, 12, 17};

/// The largest relative error of distances, and of the lengths of paths, from a vertex to all.
template <class Expected>
double worst_error(const Triangulation& surface, const ExactGeodesics& geodesics, Index source,
                   const Expected& expected) {
    const auto distances = geodesics.from_vertex(source, Progress());
    double worst = 0.0;
    for (Index v = 0; v < static_cast<Index>(surface.positions.size()); ++v) {
        if (v == source) continue;
        const double wanted = expected(v),
                     path = length_of(surface, trace_path(geodesics.unfolding(), distances, v));
        worst = std::max({worst, std::abs(at(distances, v) - wanted) / wanted,
                          std::abs(path - wanted) / wanted});
    }
    return worst;
}

/// Of distances both ways between some vertices, and of paths against their distances.
double worst_disagreement(const Triangulation& surface, const ExactGeodesics& geodesics) {
    const auto n = static_cast<Index>(surface.positions.size());
    std::vector<GeodesicDistances> all;
    double worst = 0.0;
    for (Index source = 0; source < n; source += std::max(1, n / 12)) {
        all.push_back(geodesics.from_vertex(source, Progress()));
        for (const auto& other : all) {
            const double there = at(all.back(), other.source), here = at(other, source);
            if (&other != &all.back()) worst = std::max(worst, std::abs(there - here) / here);
        }
        for (Index v = 0; v < n; ++v) {
            const double d = at(all.back(), v),
                         path =
                             length_of(surface, trace_path(geodesics.unfolding(), all.back(), v));
            if (v != source) worst = std::max(worst, std::abs(path - d) / d);
        }
    }
    return worst;
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

    TEST_CASE("tubes have the distances of their unrolled shapes, however few digits they have") {
        struct Shape {
            int columns, rows;
            double radius, height;
        };
        for (const Shape& shape : {Shape{24, 12, 60, 200},
                                   {3, 40, 10, 100},
                                   {4, 9, 5, 70},
                                   {60, 5, 60, 20},
                                   {7, 30, 1, 300},
                                   {48, 24, 60, 200}}) {
            for (const int digits : all_digits) {
                for (const Diagonals diagonals : {Diagonals::alike, Diagonals::alternating}) {
                    const int n = shape.columns;
                    const auto surface = tube(n, shape.rows, diagonals, [&](int i, int k) {
                        const double angle = 2.0 * pi * i / n;
                        return Vec3(rounded(shape.radius * std::cos(angle), digits),
                                    rounded(shape.radius * std::sin(angle), digits),
                                    rounded(shape.height * k / shape.rows, digits));
                    });
                    // Rounded or not, the sides are planes, of these widths.
                    std::vector<double> along{0.0};
                    for (Index i = 0; i < n; ++i)
                        along.push_back(
                            along.back() +
                            (surface.position(i) - surface.position((i + 1) % n)).norm());
                    const auto unrolled = [&](Index from, Index to) {
                        const double across = std::abs(along[static_cast<std::size_t>(from % n)] -
                                                       along[static_cast<std::size_t>(to % n)]);
                        return std::hypot(std::min(across, along.back() - across),
                                          surface.position(from).z() - surface.position(to).z());
                    };
                    const ExactGeodesics geodesics(surface);
                    for (const Index source : {0, n / 2 + n * (shape.rows / 2), n * 2 + 1}) {
                        CAPTURE(n);
                        CAPTURE(digits);
                        CAPTURE(source);
                        CHECK(worst_error(surface, geodesics, source,
                                          [&](Index v) { return unrolled(source, v); }) < 1e-12);
                    }
                }
            }
        }
    }

    TEST_CASE("pyramids of many sides have the distances of their unrolled shapes") {
        for (const int n : {5, 12, 24, 61}) {
            for (const int digits : all_digits) {
                constexpr int rows = 14;
                const double half = 0.5, slope = std::tan(half);
                auto surface = tube(n, rows, Diagonals::alternating, [&](int i, int k) {
                    const double height = 10.0 * (k + 1), angle = 2.0 * pi * i / n;
                    return Vec3(rounded(height * slope * std::cos(angle), digits),
                                rounded(height * slope * std::sin(angle), digits),
                                rounded(height, digits));
                });
                surface.positions.push_back(Vec3::Zero());
                const auto tip = static_cast<Index>(surface.positions.size()) - 1;
                for (Index i = 0; i < n; ++i) surface.triangles.push_back({tip, (i + 1) % n, i});
                const double side = 2.0 * std::asin(std::sin(half) * std::sin(pi / n));
                const ExactGeodesics geodesics(surface);
                for (const Index source : {Index{0}, 5 * n + n / 2, tip}) {
                    const auto unrolled = [&](Index v) {
                        const double r = surface.position(source).norm();
                        const double s = surface.position(v).norm();
                        const Index apart =
                            source == tip || v == tip ? 0 : std::abs(v - source) % n;
                        const double turn = side * std::min(apart, n - apart);
                        if (turn >= pi) return r + s;
                        return std::sqrt((r - s) * (r - s) +
                                         4.0 * r * s * std::pow(std::sin(turn / 2.0), 2));
                    };
                    // Of rounded coordinates the faces are bent.
                    const double bend = 20.0 * std::pow(10.0, -digits);
                    CAPTURE(n);
                    CAPTURE(digits);
                    CAPTURE(source);
                    CHECK(worst_error(surface, geodesics, source, unrolled) < 1e-12 + bend);
                }
                CHECK(worst_disagreement(surface, geodesics) < 1e-11);
            }
        }
    }

    TEST_CASE("grids in a plane have straight distances, however few digits they have") {
        for (const int n : {6, 25, 40}) {
            for (const int digits : all_digits) {
                const Region region = test::grid(n, n + 3, [&](double s, double t) {
                    return Vec3(rounded(70.0 * s, digits), rounded(90.0 * t, digits), 0);
                });
                const ExactGeodesics geodesics(region);
                for (const Index source : {0, n / 2, (n + 1) * (n / 2) + n / 3}) {
                    CAPTURE(digits);
                    CHECK(worst_error(region, geodesics, source,
                                      [&](Index v) { return region.distance(v, source); }) < 1e-12);
                }
            }
        }
    }

    TEST_CASE("a fan of many triangles at one vertex costs a few windows for each") {
        constexpr int n = 2000;
        for (const double total : {1.5 * pi, 1.9999 * pi, 2.5 * pi, 7.0 * pi}) {
            // Less than a full turn: the rim lies on a circle.
            const double angle = total / n;
            Triangulation fan = test::zigzag_fan(n, std::max(angle, 2.0 * pi / n));
            if (total < 2.0 * pi) {
                const double out = std::sin(angle / 2.0) / std::sin(pi / n);
                for (int i = 0; i < n; ++i)
                    fan.positions[static_cast<std::size_t>(i) + 1] =
                        Vec3(out * std::cos(2.0 * pi * i / n), out * std::sin(2.0 * pi * i / n),
                             std::sqrt(1.0 - out * out));
            }
            const ExactGeodesics geodesics(fan, 8);
            CAPTURE(total);
            CHECK(worst_error(fan, geodesics, 7, [&](Index v) {
                      if (v == 0) return 1.0;
                      const double turn = angle * std::min(std::abs(v - 7), n - std::abs(v - 7));
                      return 2.0 * std::sin(std::min(turn, pi) / 2.0);
                  }) < 1e-11);
        }
    }

    TEST_CASE("the corners of a comb, all in line, cost a few windows for each tooth") {
        constexpr int teeth = 150;
        constexpr double height = 40.0;
        const Triangulation surface = test::comb(teeth, height);
        const ExactGeodesics geodesics(surface, 8);
        const Index tips = 4 * teeth, source = tips + 2 * 60;
        const auto distances = geodesics.from_vertex(source, Progress());
        for (Index tooth = 0; tooth < teeth; ++tooth) {
            if (tooth == 60) continue;
            const double down = tooth < 60 ? height : std::hypot(height, 1.0);
            const double between = 2.0 * std::abs(tooth - 60) - 1.0;
            CAPTURE(tooth);
            CHECK(at(distances, tips + 2 * tooth + (tooth < 60 ? 1 : 0)) ==
                  doctest::Approx(down + between + height).epsilon(1e-12));
        }
        CHECK(worst_disagreement(surface, geodesics) < 1e-12);
    }

    TEST_CASE("a ramp that winds around an axis costs a few windows for each pair of corners") {
        for (const int rows : {1, 4}) {
            const Region ramp = test::grid(400 / rows, rows, [](double s, double t) {
                const double angle = 24.0 * pi * s, out = 5.0 + 45.0 * t;
                return Vec3(out * std::cos(angle), out * std::sin(angle), 10.0 * angle / (2 * pi));
            });
            CHECK(worst_disagreement(ramp, ExactGeodesics(ramp, 60)) < 1e-12);
        }
    }

    TEST_CASE("a row of saddles, each too flat to bend a path, hides no vertex") {
        for (const double bend : {2e-3, 2e-6, 2e-8}) {
            const Region region = test::grid(40, 40, [&](double u, double v) {
                return Vec3(40 * u, 40 * v, bend * 1600 * u * v);
            });
            CHECK(worst_disagreement(region, ExactGeodesics(region)) < 1e-11);
        }
    }

    TEST_CASE("paths run straight along the border of a hole") {
        const auto place = [](int i, int k) { return Vec3(10.0 * i, 10.0 * k, 0); };
        Triangulation surface = tube(9, 8, Diagonals::alike, place);
        std::erase_if(surface.triangles, [&](const Triangle& t) {
            const Index first = *std::min_element(t.begin(), t.end()), i = first % 9, k = first / 9;
            const bool closes =
                std::abs(t[0] % 9 - t[1] % 9) > 1 || std::abs(t[1] % 9 - t[2] % 9) > 1;
            return closes || (i >= 3 && i < 5 && k >= 2 && k < 5);
        });
        // Vertices within the hole are used by none.
        surface.positions.erase(surface.positions.begin() + 40);
        surface.positions.erase(surface.positions.begin() + 31);
        for (Triangle& t : surface.triangles)
            for (Index& v : t) v -= (v > 31 ? 1 : 0) + (v > 40 ? 1 : 0);
        CHECK(worst_disagreement(surface, ExactGeodesics(surface)) < 1e-12);
    }

    TEST_CASE("what does not hang together with the source is infinitely far") {
        Triangulation surface = tube(5, 3, Diagonals::alike, [](int i, int k) {
            return Vec3(std::cos(2.0 * pi * i / 5), std::sin(2.0 * pi * i / 5), k);
        });
        std::erase_if(surface.triangles, [](const Triangle& t) {
            return *std::min_element(t.begin(), t.end()) < 10 &&
                   *std::max_element(t.begin(), t.end()) >= 10;
        });
        const auto distances = ExactGeodesics(surface).from_vertex(0, Progress());
        for (Index v = 0; v < 20; ++v) CHECK(std::isfinite(at(distances, v)) == (v < 10));
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
