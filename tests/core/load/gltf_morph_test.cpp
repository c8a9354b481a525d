#include "core/load/gltf_morph.h"

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

/// Vertex 1 moves by 1 along y in the first target, vertex 2 by 2 along z in the second.
test::Json with_targets() {
    test::Json model = triangle();
    const auto first =
        add_accessor(model, raw<float>({0, 0, 0, 0, 1, 0, 0, 0, 0}), "VEC3", 5126, 3);
    const auto second =
        add_accessor(model, raw<float>({0, 0, 0, 0, 0, 0, 0, 0, 2}), "VEC3", 5126, 3);
    model["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", first}},
                                                      {{"POSITION", second}}};
    return model;
}

}  // namespace

TEST_SUITE("core/load/gltf_morph") {
    TEST_CASE("targets count by the node's weights, else by those of the mesh, else not") {
        test::Json model = with_targets();
        const Points3 plain{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
        CHECK(load_model(model.dump()).positions == plain);
        model["meshes"][0]["weights"] = {0.5, 1.0};
        CHECK(load_model(model.dump()).positions == Points3{{0, 0, 0}, {1, 0.5, 0}, {0, 2, 2}});
        model["nodes"][0]["weights"] = {0.0, 0.25};
        CHECK(load_model(model.dump()).positions == Points3{{0, 0, 0}, {1, 0, 0}, {0, 2, 0.5}});
    }

    TEST_CASE("what was moved is then transformed by the node") {
        test::Json model = with_targets();
        model["meshes"][0]["weights"] = {1.0, 0.0};
        model["nodes"][0]["scale"] = {1, 3, 1};
        CHECK(load_model(model.dump()).positions[1] == Vec3(1, 3, 0));
    }

    TEST_CASE("a sparse target without a buffer view moves only what it names") {
        test::Json model = with_targets();
        const auto index = add_accessor(model, raw<std::uint16_t>({2}), "SCALAR", 5123, 1);
        const auto value = add_accessor(model, raw<float>({7, 0, 0}), "VEC3", 5126, 1);
        const auto view = [&](std::size_t accessor) {
            return model["accessors"][accessor]["bufferView"];
        };
        test::Json& target = model["accessors"][2];
        target.erase("bufferView");
        target["sparse"] = {{"count", 1},
                            {"indices", {{"bufferView", view(index)}, {"componentType", 5123}}},
                            {"values", {{"bufferView", view(value)}}}};
        model["meshes"][0]["weights"] = {1.0, 0.0};
        CHECK(load_model(model.dump()).positions == Points3{{0, 0, 0}, {1, 0, 0}, {7, 2, 0}});
    }

    TEST_CASE("primitives that share positions and not targets have vertices of their own") {
        test::Json model = with_targets();
        model["meshes"][0]["weights"] = {1.0, 1.0};
        auto& primitives = model["meshes"][0]["primitives"];
        primitives.push_back(primitives[0]);
        CHECK(load_model(model.dump()).positions.size() == 3);
        std::swap(primitives[1]["targets"][0], primitives[1]["targets"][1]);
        primitives[1]["targets"][1] = test::Json::object();
        const RawMesh mesh = load_model(model.dump());
        REQUIRE(mesh.positions.size() == 6);
        CHECK(mesh.positions[2] == Vec3(0, 2, 2));
        CHECK(mesh.positions[4] == Vec3(1, 0, 0));
    }

    TEST_CASE("a target of another size is refused, and work is bounded") {
        test::Json model = with_targets();
        model["meshes"][0]["weights"] = {1.0, 0.0};
        model["accessors"][2]["count"] = 2;
        CHECK(has(load_error(model.dump()), "accessor 2, a morph target, has 2 elements for 3"));
        model = with_targets();
        const std::size_t many = 100;
        model["meshes"][0]["weights"] = std::vector<double>(many, 1.0);
        auto& targets = model["meshes"][0]["primitives"][0]["targets"];
        while (targets.size() < many) targets.push_back(targets[0]);
        LoadLimits limits;
        limits.triangles = 20;
        CHECK(has(load_error(model.dump(), limits), "too often"));
    }
}

}  // namespace lastflat
