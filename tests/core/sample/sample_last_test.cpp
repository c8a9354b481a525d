#include "core/sample/sample_last.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "api/problem_of.h"
#include "core/error.h"
#include "tests/helpers/sample_mesh.h"

using namespace lastflat;
using namespace lastflat::test;

namespace {

SampleLastOptions flat(double size) {
    SampleLastOptions options;
    options.size_eu = size;
    options.heel_height_mm = 0.0;
    options.toe_spring_mm = 0.0;
    return options;
}

/// The ends of the ranges in turn, and the default.
std::vector<SampleLastOptions> many_lasts() {
    std::vector<SampleLastOptions> all = {{}};
    for (const ToeShape toe :
         {ToeShape::round, ToeShape::almond, ToeShape::pointed, ToeShape::square}) {
        all.push_back({35.0, 0.0, 0.0, 0.0, toe});
        all.push_back({35.0, 80.0, 0.0, -15.0, toe});
        all.push_back({38.0, 80.0, 25.0, 0.0, toe});
        all.push_back({48.0, 40.0, 25.0, 15.0, toe});
        all.push_back({48.0, 0.0, 8.0, -15.0, toe});
    }
    return all;
}

std::string describe(const SampleLastOptions& o) {
    return "size " + std::to_string(o.size_eu) + " heel " + std::to_string(o.heel_height_mm) +
           " spring " + std::to_string(o.toe_spring_mm) + " girth " +
           std::to_string(o.extra_girth_mm) + " toe " + std::to_string(static_cast<int>(o.toe));
}

Vec3 lowest_corner(const RawMesh& mesh) {
    Vec3 low = mesh.positions.front();
    for (const Vec3& point : mesh.positions) low = low.cwiseMin(point);
    return low;
}

}  // namespace

TEST_SUITE("core/sample/sample_last") {
    TEST_CASE("closed, manifold, oriented outwards, a sphere in topology") {
        for (const SampleLastOptions& options : many_lasts()) {
            CAPTURE(describe(options));
            const RawMesh mesh = make_sample_last(options).mesh;
            const auto left = triangles_by_edge(mesh);
            int alone = 0;
            for (const auto& [edge, triangle] : left) {
                if (!left.contains({edge.second, edge.first})) ++alone;
            }
            CHECK(alone == 0);
            const auto vertices = static_cast<std::int64_t>(mesh.positions.size());
            const auto edges = static_cast<std::int64_t>(left.size() / 2);
            const auto triangles = static_cast<std::int64_t>(mesh.triangles.size());
            CHECK(vertices - edges + triangles == 2);
            std::set<Index> used;
            for (const Triangle& t : mesh.triangles) used.insert(t.begin(), t.end());
            CHECK(used.size() == mesh.positions.size());
            CHECK(*used.rbegin() + 1 == vertices);
            CHECK(volume(mesh) > 0.0);
        }
    }

    TEST_CASE("no triangle passes through another") {
        for (const SampleLastOptions& options : many_lasts()) {
            CAPTURE(describe(options));
            CHECK(self_intersections(make_sample_last(options).mesh) == 0);
        }
    }

    TEST_CASE("triangles are well shaped, about 10,000, most of them in the upper") {
        for (const SampleLastOptions& options : many_lasts()) {
            CAPTURE(describe(options));
            const RawMesh mesh = make_sample_last(options).mesh;
            std::vector<double> angles;
            std::size_t in_upper = 0;
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
                angles.push_back(smallest_angle_deg(mesh, mesh.triangles[t]));
                if (group(mesh, t) == "upper") ++in_upper;
            }
            std::sort(angles.begin(), angles.end());
            CHECK(angles.front() > 9.0);
            CHECK(angles[angles.size() / 2] > 30.0);
            CHECK(mesh.triangles.size() > 9000);
            CHECK(mesh.triangles.size() < 11000);
            CHECK(in_upper > mesh.triangles.size() * 3 / 4);
        }
    }

    TEST_CASE("curves are paths of mesh edges; groups meet along featherline and topline only") {
        for (const SampleLastOptions& options : many_lasts()) {
            CAPTURE(describe(options));
            const SampleLast last = make_sample_last(options);
            const auto left = triangles_by_edge(last.mesh);
            for (const auto& [name, path] : last.curves) {
                CAPTURE(name);
                for (std::size_t i = 1; i < path.size(); ++i) {
                    CHECK(left.contains({path[i - 1], path[i]}));
                }
            }
            std::map<std::set<std::string>, std::set<Edge>> meetings;
            for (const auto& [edge, triangle] : left) {
                const std::size_t other = left.at({edge.second, edge.first});
                const std::set<std::string> pair = {group(last.mesh, triangle),
                                                    group(last.mesh, other)};
                if (pair.size() == 2) meetings[pair].insert(undirected(edge.first, edge.second));
            }
            CHECK(meetings.size() == 2);
            CHECK(meetings[{"upper", "sole"}] == path_edges(curve(last, "featherline")));
            CHECK(meetings[{"upper", "top"}] == path_edges(curve(last, "topline")));
        }
    }

    TEST_CASE("centre_front and heel cut the upper into two disks with the borders promised") {
        const SampleLast last = make_sample_last();
        const std::vector<Index>& feather = curve(last, "featherline");
        const std::vector<Index>& top = curve(last, "topline");
        const std::vector<Index>& front = curve(last, "centre_front");
        const std::vector<Index>& back = curve(last, "heel");
        CHECK(feather.front() == feather.back());
        CHECK(top.front() == top.back());
        CHECK(back.front() == feather.front());
        CHECK(back.back() == top.front());
        const auto toe = std::find(feather.begin(), feather.end(), front.front());
        const auto throat = std::find(top.begin(), top.end(), front.back());
        REQUIRE(toe != feather.end());
        REQUIRE(throat != top.end());

        const auto lateral = half_around(last, last.lateral_vertex);
        const auto medial = half_around(last, last.medial_vertex);
        std::size_t upper = 0;
        for (std::size_t t = 0; t < last.mesh.triangles.size(); ++t) {
            if (group(last.mesh, t) == "upper") ++upper;
        }
        CHECK(lateral.size() + medial.size() == upper);
        for (const bool is_lateral : {true, false}) {
            const auto& half = is_lateral ? lateral : medial;
            std::set<Edge> expected = path_edges(front);
            expected.merge(path_edges(back));
            expected.merge(is_lateral ? path_edges({feather.begin(), toe + 1})
                                      : path_edges({toe, feather.end()}));
            expected.merge(is_lateral ? path_edges({top.begin(), throat + 1})
                                      : path_edges({throat, top.end()}));
            CHECK(border_edges(last.mesh, half) == expected);
            // A disk: one component by construction, Euler characteristic 1.
            std::set<Index> vertices;
            std::set<Edge> edges;
            for (const std::size_t t : half) {
                const Triangle& c = last.mesh.triangles[t];
                vertices.insert(c.begin(), c.end());
                for (std::size_t k = 0; k < 3; ++k) edges.insert(undirected(c[k], c[(k + 1) % 3]));
            }
            CHECK(vertices.size() + half.size() == edges.size() + 1);
        }
        CHECK(at(last.mesh, last.lateral_vertex).y() < -20.0);
        CHECK(at(last.mesh, last.medial_vertex).y() > 15.0);
    }

    TEST_CASE("a size is 20/3 mm of length and 5 mm of girth") {
        double last_length = 0.0, last_girth = 0.0;
        for (double size = 35.0; size <= 48.0; size += 1.0) {
            CAPTURE(size);
            const SampleLast last = make_sample_last(flat(size));
            const double back = at(last.mesh, curve(last, "heel").front()).x();
            const double toe = at(last.mesh, curve(last, "centre_front").front()).x();
            const double ball_girth = girth(last.mesh, back + 0.63 * (toe - back));
            CHECK(toe - back == doctest::Approx(size * 20.0 / 3.0 - 5.0).epsilon(1e-6));
            if (last_length > 0.0) {
                CHECK(std::abs(toe - back - last_length - 20.0 / 3.0) < 2e-4);
                CHECK(std::abs(ball_girth - last_girth - 5.0) < 0.1);
            }
            last_length = toe - back;
            last_girth = ball_girth;
        }
    }

    TEST_CASE("extra girth widens the ball and leaves the length alone") {
        SampleLastOptions wide = flat(42.0);
        wide.extra_girth_mm = 10.0;
        const SampleLast narrow_last = make_sample_last(flat(42.0));
        const SampleLast wide_last = make_sample_last(wide);
        const double x = 0.63 * 275.0;
        CHECK(std::abs(girth(wide_last.mesh, x) - girth(narrow_last.mesh, x) - 10.0) < 0.2);
        const Index toe = curve(wide_last, "centre_front").front();
        CHECK(at(wide_last.mesh, toe).x() == at(narrow_last.mesh, toe).x());
    }

    TEST_CASE("heel height and toe spring are those asked for, over a ball at z = 0") {
        for (const double heel : {0.0, 20.0, 80.0}) {
            for (const double spring : {0.0, 8.0, 25.0}) {
                CAPTURE(heel);
                CAPTURE(spring);
                SampleLastOptions options;
                options.heel_height_mm = heel;
                options.toe_spring_mm = spring;
                const SampleLast last = make_sample_last(options);
                const Vec3 seat = at(last.mesh, curve(last, "heel").front());
                const Vec3 toe = at(last.mesh, curve(last, "centre_front").front());
                CHECK(std::abs(seat.z() - heel) < 1e-3);
                CHECK(std::abs(toe.z() - spring) < 1e-3);
                double lowest = std::numeric_limits<double>::max();
                for (const Index v : curve(last, "featherline")) {
                    lowest = std::min(lowest, at(last.mesh, v).z());
                }
                CHECK(std::abs(lowest) < 0.5);
                CHECK(lowest_corner(last.mesh).z() > -6.0);
            }
        }
    }

    TEST_CASE("the top is flat") {
        for (const SampleLastOptions& options : many_lasts()) {
            CAPTURE(describe(options));
            const SampleLast last = make_sample_last(options);
            const std::vector<Index>& ring = curve(last, "topline");
            const Vec3 back = at(last.mesh, ring.front());
            const Vec3 front = at(last.mesh, curve(last, "centre_front").back());
            const Vec3 normal = Vec3(-(front - back).z(), 0.0, (front - back).x()).normalized();
            double farthest = 0.0;
            for (std::size_t t = 0; t < last.mesh.triangles.size(); ++t) {
                if (group(last.mesh, t) != "top") continue;
                for (const Index v : last.mesh.triangles[t]) {
                    farthest = std::max(farthest, std::abs(normal.dot(at(last.mesh, v) - back)));
                }
            }
            CHECK(farthest < 1e-3);
        }
    }

    TEST_CASE("measures of size 42 are those of a shoe") {
        const SampleLast last = make_sample_last();
        CHECK(length(last, "featherline") == doctest::Approx(645.0).epsilon(0.03));
        CHECK(length(last, "topline") == doctest::Approx(242.0).epsilon(0.03));
        CHECK(length(last, "heel") == doctest::Approx(79.0).epsilon(0.03));
        CHECK(length(last, "centre_front") == doctest::Approx(195.0).epsilon(0.04));
        const double lateral = half_area(last, last.lateral_vertex);
        const double medial = half_area(last, last.medial_vertex);
        CHECK(lateral + medial == doctest::Approx(48000.0).epsilon(0.04));
        CHECK(lateral - medial > 1000.0);  // the lateral half goes round the outer ball
    }

    TEST_CASE("the two halves are no mirror images") {
        const SampleLast last = make_sample_last();
        const std::vector<Index>& ring = curve(last, "featherline");
        double lateral_joint = 0.0, medial_joint = 0.0, lateral_y = 0.0, medial_y = 0.0;
        for (const Index v : ring) {
            const Vec3 p = at(last.mesh, v);
            if (p.y() < lateral_y) lateral_y = p.y(), lateral_joint = p.x();
            if (p.y() > medial_y) medial_y = p.y(), medial_joint = p.x();
        }
        CHECK(medial_joint - lateral_joint > 10.0);  // the ball lies askew
        CHECK(-lateral_y - medial_y > 5.0);

        // At the waist the medial wall hangs over the arch; the lateral one hardly leaves its edge.
        double edge_low = 0.0, edge_high = 0.0, wall_low = 0.0, wall_high = 0.0;
        const auto at_waist = [&](Index v) { return std::abs(at(last.mesh, v).x() - 120.0) < 6.0; };
        for (const Index v : ring) {
            if (!at_waist(v)) continue;
            edge_low = std::min(edge_low, at(last.mesh, v).y());
            edge_high = std::max(edge_high, at(last.mesh, v).y());
        }
        for (Index v = 0; v < static_cast<Index>(last.mesh.positions.size()); ++v) {
            if (!at_waist(v)) continue;
            wall_low = std::min(wall_low, at(last.mesh, v).y());
            wall_high = std::max(wall_high, at(last.mesh, v).y());
        }
        const double lateral_overhang = edge_low - wall_low;
        const double medial_overhang = wall_high - edge_high;
        CHECK(medial_overhang > lateral_overhang + 0.5);
    }

    TEST_CASE("toe shapes differ at the toe and nowhere behind the ball") {
        std::vector<double> widths;
        for (const ToeShape toe :
             {ToeShape::pointed, ToeShape::almond, ToeShape::round, ToeShape::square}) {
            SampleLastOptions options = flat(42.0);
            options.toe = toe;
            const SampleLast last = make_sample_last(options);
            double low = 0.0, high = 0.0;
            for (const Index v : curve(last, "featherline")) {
                const Vec3 p = at(last.mesh, v);
                if (p.x() < 0.9 * 275.0) continue;
                low = std::min(low, p.y());
                high = std::max(high, p.y());
            }
            widths.push_back(high - low);
            CHECK(std::abs(girth(last.mesh, 60.0) -
                           girth(make_sample_last(flat(42.0)).mesh, 60.0)) < 2.0);
        }
        for (std::size_t i = 1; i < widths.size(); ++i) CHECK(widths[i] > widths[i - 1] + 5.0);
    }

    TEST_CASE("the upper is smooth: no crease but at its two borders") {
        for (const SampleLastOptions& options : many_lasts()) {
            CAPTURE(describe(options));
            const SampleLast last = make_sample_last(options);
            const auto left = triangles_by_edge(last.mesh);
            const auto normal = [&](std::size_t t) {
                const Triangle& c = last.mesh.triangles[t];
                const Vec3 a = at(last.mesh, c[0]);
                return Vec3((at(last.mesh, c[1]) - a).cross(at(last.mesh, c[2]) - a).normalized());
            };
            double sharpest_upper = 1.0, bluntest_feather = -1.0;
            for (const auto& [edge, triangle] : left) {
                const std::size_t other = left.at({edge.second, edge.first});
                const double cosine = normal(triangle).dot(normal(other));
                const std::string here = group(last.mesh, triangle),
                                  there = group(last.mesh, other);
                if (here == "upper" && there == "upper") {
                    sharpest_upper = std::min(sharpest_upper, cosine);
                } else if (here == "sole" && there == "upper") {
                    bluntest_feather = std::max(bluntest_feather, cosine);
                }
            }
            CHECK(sharpest_upper > std::cos(39.0 * std::numbers::pi / 180.0));
            CHECK(bluntest_feather < std::cos(40.0 * std::numbers::pi / 180.0));
        }
    }

    TEST_CASE("coordinates have four decimals, and the same options give the same last") {
        const SampleLast first = make_sample_last(), second = make_sample_last();
        CHECK(first.mesh.triangles == second.mesh.triangles);
        CHECK(first.mesh.positions == second.mesh.positions);
        CHECK(first.curves == second.curves);
        int other = 0;
        for (const Vec3& point : first.mesh.positions) {
            for (const double value : point) {
                if (std::round(value * 1e4) / 1e4 != value) ++other;
                if (value == 0.0 && std::signbit(value)) ++other;
            }
        }
        CHECK(other == 0);
    }

    TEST_CASE("an option out of its range is named") {
        const auto refused = [](const SampleLastOptions& options) -> std::string {
            try {
                (void)make_sample_last(options);
            } catch (const Error& error) {
                CHECK(error.code() == ErrorCode::unsupported_request);
                return api::json_pointer(error.option().value());
            }
            return "nothing";
        };
        CHECK(refused({}) == "nothing");
        CHECK(refused({29.9, 20.0, 8.0, 0.0, ToeShape::round}) == "/size_eu");
        CHECK(refused({50.1, 20.0, 8.0, 0.0, ToeShape::round}) == "/size_eu");
        CHECK(refused({42.0, -1.0, 8.0, 0.0, ToeShape::round}) == "/heel_height_mm");
        CHECK(refused({42.0, 80.1, 8.0, 0.0, ToeShape::round}) == "/heel_height_mm");
        CHECK(refused({42.0, 20.0, 25.1, 0.0, ToeShape::round}) == "/toe_spring_mm");
        CHECK(refused({42.0, 20.0, 8.0, -15.1, ToeShape::round}) == "/extra_girth_mm");
        CHECK(refused({std::nan(""), 20.0, 8.0, 0.0, ToeShape::round}) == "/size_eu");
    }
}
