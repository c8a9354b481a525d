#include "core/plan/close_opening.h"

#include <doctest/doctest.h>

#include "core/export/write_model.h"
#include "core/flatten.h"
#include "core/locate/surface_search.h"
#include "core/sample/sample_last.h"
#include "core/weld/weld.h"

namespace lastflat {
namespace {

/// The sample last without the faces of one group, and without names.
RawMesh without(const std::string& group) {
    RawMesh mesh = make_sample_last().mesh;
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& names = mesh.label_sets[mesh.triangle_labels[t]];
        if (std::find(names.begin(), names.end(), group) != names.end()) continue;
        mesh.triangles[kept++] = mesh.triangles[t];
    }
    mesh.triangles.resize(kept);
    mesh.label_sets = {{}};
    mesh.triangle_labels.assign(kept, 0);
    return mesh;
}

double length_of(const FlattenResult& result, const std::string& curve) {
    for (const CurveReport& report : result.regions.at(0).curves) {
        if (report.name == curve) return report.length_3d_mm;
    }
    return 0.0;
}

}  // namespace

TEST_SUITE("core/plan/close_opening") {
    TEST_CASE("a last without its top or its sole gives the halves of the whole one") {
        RawMesh whole = without("");
        Progress progress;
        const FlattenResult expected = flatten(write_model_obj(whole), {}, progress);
        for (const char* missing : {"top", "sole"}) {
            CAPTURE(missing);
            const FlattenResult result = flatten(write_model_obj(without(missing)), {}, progress);
            REQUIRE(result.regions.size() == 2);
            for (const char* curve : {"centre_front", "heel", "topline", "featherline"})
                CHECK(length_of(result, curve) ==
                      doctest::Approx(length_of(expected, curve)).epsilon(1e-3));
            REQUIRE(result.repairs.size() == 1);
            CHECK(result.repairs[0].code == "opening_closed");
            CHECK(result.repairs[0].detail.find(std::string(missing) == "top"
                                                    ? "topline"
                                                    : "featherline") != std::string::npos);
        }
    }

    TEST_CASE("a last with a hole in its side is refused, with the place, unless holes are kept") {
        RawMesh punched = without("");
        const Vec3 side(75.0, -50.0, 55.0);
        const Vec3 nearest = SurfaceSearch(weld(punched)).nearest(side).position;
        std::size_t kept = 0;
        for (const Triangle& t : punched.triangles) {
            if ((punched.positions[at(t[0])] - nearest).norm() > 16.0)
                punched.triangles[kept++] = t;
        }
        punched.triangles.resize(kept);
        punched.triangle_labels.resize(kept);
        SurfaceMesh surface = weld(punched);
        REQUIRE(is_open(surface));
        std::optional<Vec3> place;
        try {
            close_opening(surface, {});
        } catch (const Error& error) {
            CHECK(error.code() == ErrorCode::region_invalid);
            place = error.position();
        }
        REQUIRE(place);
        CHECK((*place - nearest).norm() < 8.0);
        Request keep;
        keep.cut.holes = HoleRule::keep;
        close_opening(surface, keep);
        CHECK(is_open(surface));
    }

    TEST_CASE("an opening elsewhere stays, and so does one of a request that says how to cut") {
        RawMesh toeless = without("");
        std::size_t kept = 0;
        for (const Triangle& t : toeless.triangles) {
            if (toeless.positions[at(t[0])].x() < 220.0) toeless.triangles[kept++] = t;
        }
        toeless.triangles.resize(kept);
        toeless.triangle_labels.resize(kept);
        SurfaceMesh surface = weld(toeless);
        Request keep;
        keep.cut.holes = HoleRule::keep;
        close_opening(surface, keep);
        CHECK(is_open(surface));
        SurfaceMesh topless = weld(without("top"));
        Request asked;
        asked.cut.cuts = {"centre_front"};
        close_opening(topless, asked);
        CHECK(is_open(topless));
        close_opening(topless, {});
        CHECK_FALSE(is_open(topless));
    }
}

}  // namespace lastflat
