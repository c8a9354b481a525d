#include "core/load/gltf_skin.h"

#include <doctest/doctest.h>

#include "core/load/load_model.h"
#include "tests/helpers/errors.h"
#include "tests/helpers/gltf.h"

namespace lastflat {
namespace {

using test::add_accessor;
using test::has;
using test::load_error;
using test::raw;
using test::triangle;

/// The triangle, bound to two joints: vertices 0 and 1 to the first, 2 to both alike. The joints
/// stand under a node of their own; the mesh's node is moved, which must not matter.
test::Json with_skin() {
    test::Json model = triangle();
    const auto joints = add_accessor(model, raw<std::uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0}),
                                     "VEC4", 5121, 3);
    const auto weights =
        add_accessor(model, raw<float>({1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0}), "VEC4", 5126, 3);
    auto& attributes = model["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = joints;
    attributes["WEIGHTS_0"] = weights;
    model["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}},
                      {{"children", {2, 3}}, {"scale", {2, 1, 1}}},
                      {{"name", "a"}},
                      {{"name", "b"}, {"translation", {0, 4, 0}}}};
    model["scenes"][0]["nodes"] = {0, 1};
    model["skins"] = {{{"joints", {2, 3}}}};
    return model;
}

}  // namespace

TEST_SUITE("core/load/gltf_skin") {
    TEST_CASE("vertices follow their joints at rest, and not the node of the mesh") {
        const RawMesh mesh = load_model(with_skin().dump());
        CHECK(mesh.positions == Points3{{0, 0, 0}, {2, 0, 0}, {0, 4, 0}});
        CHECK(mesh.triangles[0] == Triangle{0, 1, 2});
    }

    TEST_CASE("inverse bind matrices come first, column by column") {
        test::Json model = with_skin();
        model["skins"][0]["inverseBindMatrices"] =
            add_accessor(model, raw<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1,
                                            1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 3, 1}),
                         "MAT4", 5126, 2);
        const RawMesh mesh = load_model(model.dump());
        CHECK(mesh.positions == Points3{{10, 0, 0}, {12, 0, 0}, {5, 4, 1.5}});
    }

    TEST_CASE("weights that do not sum to one are taken as shares") {
        test::Json model = with_skin();
        const auto weights = add_accessor(
            model, raw<std::uint8_t>({9, 0, 0, 0, 4, 0, 0, 0, 60, 20, 0, 0}), "VEC4", 5121, 3);
        model["accessors"][weights]["normalized"] = true;
        model["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = weights;
        CHECK((load_model(model.dump()).positions[2] - Vec3(0, 3, 0)).norm() < 1e-12);
    }

    TEST_CASE("morph targets move vertices before the joints do") {
        test::Json model = with_skin();
        const auto target =
            add_accessor(model, raw<float>({0, 0, 0, 1, 0, 0, 0, 0, 0}), "VEC3", 5126, 3);
        model["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", target}}};
        model["meshes"][0]["weights"] = {1.0};
        CHECK(load_model(model.dump()).positions[1] == Vec3(4, 0, 0));
    }

    TEST_CASE("joints that mirror turn the winding") {
        test::Json model = with_skin();
        model["nodes"][1]["scale"] = {-2, 1, 1};
        CHECK(load_model(model.dump()).triangles[0] == Triangle{0, 2, 1});
        model = with_skin();
        model["nodes"][0]["scale"] = {-1, 1, 1};
        CHECK(load_model(model.dump()).triangles[0] == Triangle{0, 1, 2});
    }

    TEST_CASE("what a skin lacks is named") {
        test::Json model = with_skin();
        auto& attributes = model["meshes"][0]["primitives"][0]["attributes"];
        attributes.erase("WEIGHTS_0");
        CHECK(has(load_error(model.dump()), "JOINTS or WEIGHTS without the other"));
        attributes.erase("JOINTS_0");
        CHECK(has(load_error(model.dump()), "unsupported_model: glTF: node 0 has a skin"));
        model = with_skin();
        model["skins"][0]["joints"] = {2};
        CHECK(has(load_error(model.dump()), "names a joint that the skin does not have"));
        model["skins"][0]["joints"] = {2, 9};
        CHECK(has(load_error(model.dump()), "node 9 does not exist"));
        model = with_skin();
        model["accessors"][3]["count"] = 2;
        CHECK(has(load_error(model.dump()), "accessor 3, of a skin, has 2 elements"));
        model = with_skin();
        model["nodes"][2]["children"] = {1};
        model["scenes"][0]["nodes"] = {0};
        CHECK(has(load_error(model.dump()), "has too many ancestors"));
    }
}

}  // namespace lastflat
