#include "core/landmarks/landmarks.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include "core/landmarks/min_cut.h"
#include "core/sample/sample_last.h"
#include "core/weld/weld.h"
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

void check_found(const SampleLast& last, const Landmarks& found, const SurfaceMesh& surface,
                 const RawMesh& raw) {
    REQUIRE(found.curves.size() == 4);
    for (const CurveSource& curve : found.curves) {
        Points3 truth;
        for (const auto& [name, vertices] : last.curves) {
            if (name != curve.name) continue;
            for (const Index v : vertices)
                truth.push_back(raw.positions[static_cast<std::size_t>(v)]);
        }
        const bool closed = curve.name == "featherline" || curve.name == "topline";
        const auto off = test::distance_between(truth, points_of(surface, curve));
        CAPTURE(curve.name);
        CHECK(off.mean < (closed ? 1.0 : 1.5));
        CHECK(off.most < 3.0);
    }
}

}  // namespace

TEST_SUITE("core/landmarks") {
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
            check_found(last, found, surface, raw);
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
