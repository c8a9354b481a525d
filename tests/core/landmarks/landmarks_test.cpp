#include "core/landmarks/landmarks.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <random>

#include "core/landmarks/furthest_pair.h"
#include "core/landmarks/min_cut.h"
#include "core/landmarks/smooth_normals.h"
#include "core/numerics/geometry.h"
#include "core/sample/sample_last.h"
#include "core/weld/weld.h"
#include "tests/helpers/bare_sample.h"
#include "tests/helpers/curve_distance.h"

namespace lastflat {
namespace {

/// The sample last without its groups, moved.
RawMesh bare(const SampleLast& last, const Eigen::Affine3d& motion) {
    RawMesh raw = last.mesh;
    for (Vec3& p : raw.positions) p = motion * p;
    raw.label_sets = {{}};
    raw.triangle_labels.assign(raw.triangles.size(), 0);
    if (motion.linear().determinant() < 0.0) {
        for (Triangle& t : raw.triangles) std::swap(t[1], t[2]);
    }
    return raw;
}

void check_found(const SampleLast& last, const Landmarks& found, const RawMesh& raw) {
    REQUIRE(found.curves.size() == 4);
    for (const CurveSource& curve : found.curves) {
        Points3 truth;
        for (const auto& [name, vertices] : last.curves) {
            if (name != curve.name) continue;
            for (const Index v : vertices)
                truth.push_back(raw.positions[static_cast<std::size_t>(v)]);
        }
        const bool closed = curve.name == "featherline" || curve.name == "topline";
        const auto off = test::distance_between(truth, points_of(curve));
        CAPTURE(curve.name);
        CHECK(off.mean < (closed ? 1.0 : 1.5));
        CHECK(off.most < 3.0);
    }
}

}  // namespace

TEST_SUITE("core/landmarks") {
    TEST_CASE("where vertices lie to and fro beside the edge, the line is as long as the edge") {
        RawMesh jagged = test::subdivided(test::subdivided(test::bare_sample()));
        const SurfaceMesh plain = weld(jagged);
        const Landmarks expected = find_landmarks(plain);
        const Points3& edge = points_of(expected.curves.at(0));
        double zigzag = 0.0;
        Vec3 before = edge.back();
        for (std::size_t i = 0; i + 1 < edge.size(); ++i) {
            const auto vertex =
                std::find(jagged.positions.begin(), jagged.positions.end(), edge[i]);
            REQUIRE(vertex != jagged.positions.end());
            if (i % 2 == 0)  // over the sole
                *vertex += 0.5 * (Vec3(120.0, 0.0, vertex->z()) - *vertex).normalized();
            zigzag += (*vertex - before).norm();
            before = *vertex;
        }
        const SurfaceMesh surface = weld(jagged);
        const Landmarks found = find_landmarks(surface);
        REQUIRE(found.curves.at(0).name == curve_name::featherline);
        const double length = length_of(points_of(expected.curves[0]));
        CHECK(zigzag > 1.03 * length);
        CHECK(length_of(points_of(found.curves[0])) == doctest::Approx(length).epsilon(0.01));
        CHECK(found.curves[2].name == curve_name::centre_front);
        CHECK(length_of(points_of(found.curves[2])) <
              length_of(points_of(expected.curves[2])) + 5.0);
    }

    TEST_CASE("a bare last is read wherever it lies, and as the other foot in a mirror") {
        const SampleLast last = make_sample_last();
        Eigen::Affine3d turned(Eigen::AngleAxisd(2.1, Vec3(1, -2, 0.5).normalized()));
        turned.pretranslate(Vec3(300, -40, 17));
        Eigen::Affine3d mirrored = turned;
        mirrored.scale(Vec3(1, -1, 1));
        Foot foot = Foot::right;
        for (const auto& motion :
             {Eigen::Affine3d(Eigen::Affine3d::Identity()), turned, mirrored}) {
            const RawMesh raw = bare(last, motion);
            WeldOptions options;
            options.unit_mm = 1.0;
            const SurfaceMesh surface = weld(raw, options);
            const Landmarks found = find_landmarks(surface);
            check_found(last, found, raw);
            CHECK(found.warnings.empty());
            if (motion.linear().determinant() > 0.0)
                foot = found.foot;
            else
                CHECK(found.foot != foot);
            const auto lateral = found.cut.regions.at(0), medial = found.cut.regions.at(1);
            CHECK(lateral.name == "lateral");
            // The true sides are those of the sample.
            const auto side = [&](const Location& inside) {
                return raw.positions[at(std::get<Index>(inside))];
            };
            CHECK((side(*lateral.inside) - side(last.lateral_vertex)).norm() <
                  (side(*lateral.inside) - side(last.medial_vertex)).norm());
            CHECK((side(*medial.inside) - side(last.medial_vertex)).norm() <
                  (side(*medial.inside) - side(last.lateral_vertex)).norm());
        }
    }

    TEST_CASE("triangles that share no vertices make no difference") {
        const SampleLast last = make_sample_last();
        RawMesh soup = bare(last, Eigen::Affine3d(Eigen::Affine3d::Identity()));
        const RawMesh whole = soup;
        soup.positions.clear();
        for (Triangle& t : soup.triangles) {
            for (Index& v : t) {
                soup.positions.push_back(whole.positions[static_cast<std::size_t>(v)]);
                v = static_cast<Index>(soup.positions.size()) - 1;
            }
        }
        soup.indexed = false;
        WeldOptions options;
        options.unit_mm = 1.0;
        const Landmarks found = find_landmarks(weld(soup, options));
        CHECK(found.warnings.empty());
        CHECK(found.foot == Foot::right);
    }

    TEST_CASE("noise moves no curve far, and the last stays upright") {
        const SampleLast last = make_sample_last();
        for (const double amplitude : {0.05, 0.1, 0.3}) {
            CAPTURE(amplitude);
            RawMesh raw = bare(last, Eigen::Affine3d::Identity());
            std::mt19937 random(7);
            std::normal_distribution<double> noise(0.0, amplitude);
            for (Vec3& p : raw.positions) p += Vec3(noise(random), noise(random), noise(random));
            const SurfaceMesh surface = weld(raw);
            const Landmarks found = find_landmarks(surface);
            CHECK(found.foot == Foot::right);
            CHECK(found.up.z() > 0.95);
            CHECK(found.forward.x() > 0.95);
            check_found(last, found, raw);
        }
    }

    TEST_CASE("what is smoothed is noise; a coarse or clean last keeps its normals") {
        const SampleLast last = make_sample_last();
        RawMesh raw = bare(last, Eigen::Affine3d::Identity());
        const SurfaceMesh clean = weld(raw);
        auto faces = bare_faces(clean);
        const double bend = typical_bend(clean, faces);
        CHECK_FALSE(smooth_normals(clean, faces));
        CHECK(typical_bend(clean, faces) == bend);
        std::mt19937 random(3);
        std::normal_distribution<double> noise(0.0, 0.2);
        for (Vec3& p : raw.positions) p += Vec3(noise(random), noise(random), noise(random));
        const SurfaceMesh noisy = weld(raw);
        auto rough = bare_faces(noisy);
        CHECK(typical_bend(noisy, rough) > 4.0 * bend);
        CHECK(smooth_normals(noisy, rough));
        CHECK(typical_bend(noisy, rough) < 1.5 * bend);
        double turned = 0.0, all = 0.0;
        for (std::size_t f = 0; f < faces.size(); ++f) {
            turned += faces[f].area * angle_between(faces[f].normal, rough[f].normal);
            all += faces[f].area;
        }
        CHECK(turned / all < 0.06);  // radians; sharp edges stand where they stood
    }

    TEST_CASE("the ends of a round line are where its ends are, wherever its vertices lie") {
        for (const double first : {0.0, 0.3, 0.7}) {
            Points3 ellipse;
            for (int i = 0; i <= 60; ++i) {
                const double angle = 2.0 * std::numbers::pi * (i % 60 + first) / 60.0;
                const double off = 0.05 * (i % 2 == 0 ? 1.0 : -1.0);
                ellipse.emplace_back((130.0 + off) * std::cos(angle), 45.0 * std::sin(angle), 0.0);
            }
            const auto [back, front] = furthest_pair(ellipse, Vec3(1.0, 0.0, 0.0));
            CHECK((back - Vec3(-130.0, 0.0, 0.0)).norm() < 0.6);
            CHECK((front - Vec3(130.0, 0.0, 0.0)).norm() < 0.6);
        }
    }

    TEST_CASE("a notch in the top, as a hinged last has, is refused with its place") {
        RawMesh raw = bare(make_sample_last(), Eigen::Affine3d::Identity());
        for (Vec3& p : raw.positions) {
            const double off = std::abs(p.x() - 64.0) / 6.0;
            if (p.z() > 80.0 && off < 1.0) p.z() -= 24.0 * (1.0 - off);
        }
        CHECK_THROWS_WITH_AS((void)find_landmarks(weld(raw)),
                             doctest::Contains("runs into a notch or a hole at"), Error);
    }

    TEST_CASE("what is no last says what is needed") {
        RawMesh box;
        box.label_sets = {{}};
        for (const double z : {0.0, 30.0}) {
            for (const double y : {0.0, 40.0}) {
                for (const double x : {0.0, 200.0}) box.positions.emplace_back(x, y, z);
            }
        }
        box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                         {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
        box.triangle_labels.assign(12, 0);
        try {
            (void)find_landmarks(weld(box));
            FAIL("a box was taken for a last");
        } catch (const Error& error) {
            CHECK(error.code() == ErrorCode::region_invalid);
            CHECK(std::string(error.what()).find("name the curves") != std::string::npos);
        }
    }

    TEST_CASE("a minimum cut is the cheapest") {
        // 0 - 1 - 2 - 3 and 0 - 3 by the side: the two cheapest of the way must go.
        const std::vector<GraphEdge> edges{{0, 1, 5.0}, {1, 2, 1.0}, {2, 3, 4.0}, {0, 3, 2.0}};
        const std::vector<Side2> nodes{Side2::first, Side2::free, Side2::free, Side2::second};
        CHECK(minimum_cut(edges, nodes) == std::vector<bool>{true, true, false, false});
    }
}

}  // namespace lastflat
