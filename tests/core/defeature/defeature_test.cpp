#include "core/defeature/defeature.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "core/export/write_model.h"
#include "core/flatten.h"
#include "core/locate/surface_search.h"
#include "core/numerics/geometry.h"
#include "core/plan/plan.h"
#include "core/weld/weld.h"
#include "tests/helpers/bare_sample.h"

namespace lastflat {
namespace {

/// What stands out of the last, or goes into it, at a place.
struct Carried {
    std::string what;
    Vec3 place;
    double radius;
    Vec3 by;
    const char* bridged;  ///< the curve that runs there; none: ""
};

const std::vector<Carried> workshop{
    {"blind jack-pin hole", {60.0, 0.0, 100.0}, 14.0, {0.0, 0.0, -40.0}, ""},
    {"knob on the side", {75.0, -50.0, 55.0}, 12.0, {0.0, -5.0, 0.0}, ""},
    {"knob on the instep", {195.0, 5.0, 40.0}, 9.0, {2.0, 0.0, 6.0}, curve_name::centre_front},
    {"nail in the heel", {-5.0, 0.0, 47.0}, 8.0, {-6.0, 0.0, 0.0}, curve_name::heel},
    {"hole in the featherline",
     {193.0, 40.0, 0.5},
     13.0,
     {0.0, -12.0, 0.0},
     curve_name::featherline},
    {"knob on the topline", {60.0, -12.5, 93.2}, 9.0, {0.0, -3.0, 5.0}, curve_name::topline},
    {"hole in the sole", {60.0, 0.0, 10.0}, 9.0, {0.0, 0.0, 15.0}, ""},
};

const SurfaceMesh& plain() {
    static const SurfaceMesh surface = weld(test::subdivided(test::bare_sample()));
    return surface;
}

RawMesh with(const Carried& feature) {
    RawMesh mesh = test::subdivided(test::bare_sample());
    const Vec3 nearest = SurfaceSearch(plain()).nearest(feature.place).position;
    const auto patch = test::patch_at(mesh, nearest, feature.radius / 2.0);
    REQUIRE(patch.size() > 2);
    test::push(mesh, patch, feature.by);
    return mesh;
}

double area_of(const SurfaceMesh& surface) {
    double area = 0.0;
    for (const auto face : surface.mesh.faces())
        area += 0.5 * doubled_area_vector(surface, corners_of(surface, face.idx())).norm();
    return area;
}

/// A plate of 200 x 20 x 200 mm with a hole of 6 x 6 mm.
RawMesh plate_with_hole() {
    RawMesh mesh;
    for (const double y : {0.0, 20.0}) {
        for (const double half : {100.0, 3.0}) {
            for (const auto& [x, z] : {std::pair(-1.0, -1.0), std::pair(1.0, -1.0),
                                       std::pair(1.0, 1.0), std::pair(-1.0, 1.0)})
                mesh.positions.emplace_back(half * x, y, half * z);
        }
    }
    const auto square = [&](Index a, Index b, Index c, Index d) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    };
    for (Index i = 0; i < 4; ++i) {
        const Index j = (i + 1) % 4;
        square(i, j, j + 4, i + 4);            // in front, around the hole
        square(j + 8, i + 8, i + 12, j + 12);  // behind
        square(j, i, i + 8, j + 8);            // outside
        square(i + 4, j + 4, j + 12, i + 12);  // in the hole
    }
    mesh.label_sets = {{}};
    mesh.triangle_labels.assign(mesh.triangles.size(), 0);
    return mesh;
}

/// A plate of 200 x 20 x 200 mm with a saw cut of 20 x 1.2 mm in one end.
RawMesh sawn_plate() {
    RawMesh mesh;
    const std::vector<std::pair<double, double>> outline{
        {-100.0, -100.0}, {100.0, -100.0}, {100.0, -0.6},  {80.0, -0.6},
        {80.0, 0.6},      {100.0, 0.6},    {100.0, 100.0}, {-100.0, 100.0}};
    for (const double y : {0.0, 20.0}) {
        for (const auto& [x, z] : outline) mesh.positions.emplace_back(x, y, z);
    }
    for (const auto& [a, b, c] :
         std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 7}, {4, 6, 7}, {4, 5, 6}}) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({b + 8, a + 8, c + 8});
    }
    for (Index i = 0; i < 8; ++i) {
        const Index j = (i + 1) % 8;
        mesh.triangles.push_back({j, i, i + 8});
        mesh.triangles.push_back({j, i + 8, j + 8});
    }
    mesh.label_sets = {{}};
    mesh.triangle_labels.assign(mesh.triangles.size(), 0);
    return mesh;
}

std::size_t named(const std::vector<Warning>& warnings, const std::string& curve) {
    std::size_t count = 0;
    for (const Warning& warning : warnings) {
        if (warning.code != "landmark_unsure" || !warning.position) continue;
        count += warning.detail.find("the " + curve + " bridges") == 0 ? 1 : 0;
    }
    return count;
}

}  // namespace

TEST_SUITE("core/defeature/defeature") {
    TEST_CASE("what a workshop's last carries is taken off, and moves no curve beside it") {
        const Landmarks expected = find_landmarks(plain());
        for (const Carried& feature : workshop) {
            CAPTURE(feature.what);
            SurfaceMesh surface = weld(with(feature));
            CHECK(area_of(surface) > area_of(plain()) + 40.0);
            defeature(surface, {});
            CHECK(area_of(surface) == doctest::Approx(area_of(plain())).epsilon(5e-4));
            REQUIRE(surface.filled.size() == 1);
            REQUIRE(surface.repairs.size() == 1);
            CHECK(surface.repairs[0].code == "features_filled");
            const Vec3 place = SurfaceSearch(plain()).nearest(feature.place).position;
            CHECK((surface.repairs[0].positions.at(0) - place).norm() < 3.0);
            const Plan plan = make_plan(surface, {});
            for (const CurveSource& curve : plan.request.curves) {
                CAPTURE(curve.name);
                const auto before = std::find_if(
                    expected.curves.begin(), expected.curves.end(),
                    [&](const CurveSource& other) { return other.name == curve.name; });
                const Points3 line = points_of(*before);
                for (const Vec3& p : points_of(curve)) {
                    if ((p - place).norm() > feature.radius) CHECK(distance_to_line(line, p) < 1.0);
                }
                const bool is_bridged = curve.name == feature.bridged;
                CHECK(named(plan.landmarks->warnings, curve.name) == (is_bridged ? 1 : 0));
                CHECK(length_of(points_of(curve)) ==
                      doctest::Approx(length_of(line)).epsilon(is_bridged ? 1.5e-3 : 1e-3));
            }
        }
    }

    TEST_CASE("a nail where two lines meet is bridged by both, which still meet") {
        const auto expected = find_landmarks(plain());
        const auto line = [](const std::vector<CurveSource>& curves, const std::string& name) {
            return points_of(*std::find_if(curves.begin(), curves.end(),
                                           [&](const auto& curve) { return curve.name == name; }));
        };
        const Points3 centre = line(expected.curves, curve_name::centre_front);
        const Vec3 corner = centre.front().z() > centre.back().z() ? centre.front() : centre.back();
        const RawMesh nailed = with({"nail", corner, 8.0, {1.0, 0.0, 5.0}, ""});
        SurfaceMesh surface = weld(nailed);
        defeature(surface, {});
        const Plan plan = make_plan(surface, {});
        for (const std::string name : {curve_name::centre_front, curve_name::topline}) {
            CAPTURE(name);
            CHECK(named(plan.landmarks->warnings, name) == 1);
            CHECK(std::abs(length_of(line(plan.request.curves, name)) -
                           length_of(line(expected.curves, name))) < 1.0);
        }
        const Points3 bridged = line(plan.request.curves, curve_name::centre_front);
        const Points3 topline = line(plan.request.curves, curve_name::topline);
        CHECK(std::min(distance_to_line(topline, bridged.front()),
                       distance_to_line(topline, bridged.back())) < 0.05);
        Progress progress;
        const FlattenResult result = flatten(write_model_obj(nailed), {}, progress);
        REQUIRE(result.regions.size() == 2);
        for (const auto& region : result.regions) CHECK(region.metrics.flipped_triangles == 0);
    }

    TEST_CASE("a hole that runs through is closed at both ends, and said to run through") {
        for (const bool is_fine : {false, true}) {  // a rim with corners alone, or points between
            CAPTURE(is_fine);
            SurfaceMesh surface =
                weld(is_fine ? test::subdivided(plate_with_hole()) : plate_with_hole());
            Request fill;
            fill.cut.features = FeatureRule::fill;
            defeature(surface, fill);
            REQUIRE(surface.filled.size() == 2);
            CHECK(surface.filled[0].across_mm == doctest::Approx(6.0 * std::sqrt(2.0)));
            CHECK(std::abs(surface.filled[0].centre.y() - surface.filled[1].centre.y()) ==
                  doctest::Approx(20.0));
            REQUIRE(surface.repairs.size() == 1);
            CHECK(surface.repairs[0].count == 1);
            CHECK(surface.repairs[0].detail.find("1 of them ran through it") != std::string::npos);
            CHECK(area_of(surface) == doctest::Approx(2.0 * (200.0 * 200.0 + 2.0 * 200.0 * 20.0)));
        }
    }

    TEST_CASE("of a saw cut all goes, though its walls are hollow at their end alone") {
        SurfaceMesh surface = weld(test::subdivided(test::subdivided(sawn_plate())));
        Request fill;
        fill.cut.features = FeatureRule::fill;
        defeature(surface, fill);
        REQUIRE(surface.filled.size() == 1);
        CHECK(surface.filled[0].across_mm > 20.0);
        CHECK(area_of(surface) == doctest::Approx(96'000.0));
    }

    TEST_CASE("features stay where the request says so, or says how to cut") {
        Request keep, cuts;
        keep.cut.features = FeatureRule::keep;
        cuts.cut.cuts = {"heel"};
        for (const Request& request : {keep, cuts}) {
            SurfaceMesh surface = weld(with(workshop[2]));
            const std::size_t faces = surface.mesh.n_faces();
            defeature(surface, request);
            CHECK(surface.mesh.n_faces() == faces);
            CHECK(surface.repairs.empty());
        }
        cuts.cut.features = FeatureRule::fill;
        SurfaceMesh surface = weld(with(workshop[2]));
        defeature(surface, cuts);
        CHECK(surface.repairs.size() == 1);
    }

    TEST_CASE("a feature that is larger than 15 mm stays") {
        for (const double radius : {6.0, 16.0}) {
            Carried knob = workshop[1];
            knob.radius = 2.0 * radius;
            SurfaceMesh surface = weld(with(knob));
            defeature(surface, {});
            CHECK(surface.filled.size() == (radius < 7.5 ? 1 : 0));
        }
    }

    TEST_CASE("a last without features is left as it is") {
        SurfaceMesh surface = weld(test::bare_sample());
        const std::size_t faces = surface.mesh.n_faces();
        defeature(surface, {});
        CHECK(surface.mesh.n_faces() == faces);
        CHECK(surface.repairs.empty());
    }

    TEST_CASE("what was found, run as a request, gives the same pattern") {
        const std::string model = write_model_obj(with(workshop[3]));
        Progress progress;
        const FlattenResult bare = flatten(model, {}, progress);
        FlattenOptions again;
        again.request = bare.plan.request;
        CHECK(again.request.cut.features == FeatureRule::fill);
        const FlattenResult result = flatten(model, again, progress);
        REQUIRE(result.regions.size() == bare.regions.size());
        for (std::size_t r = 0; r < result.regions.size(); ++r)
            CHECK(result.regions[r].chart.uv == bare.regions[r].chart.uv);
    }
}

}  // namespace lastflat
