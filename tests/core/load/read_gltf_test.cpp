#include <doctest/doctest.h>

#include "core/load/load_model.h"
#include "tests/helpers/errors.h"
#include "tests/helpers/gltf.h"

namespace lastflat {
namespace {

using test::has;
using test::load_error;

using test::base64;
using test::raw;
using test::triangle;

using Json = nlohmann::json;

}  // namespace

TEST_SUITE("core/load/read_gltf") {
    TEST_CASE("positions, groups and the metre are read") {
        const RawMesh mesh = load_model(triangle().dump());
        REQUIRE(mesh.triangles.size() == 1);
        CHECK(mesh.positions[2] == Vec3(0, 2, 0));
        CHECK(mesh.default_unit_mm == 1000.0);
        CHECK(mesh.label_sets[mesh.triangle_labels[0]] ==
              std::vector<std::string>{"foot", "last", "calf"});
    }

    TEST_CASE("transforms of nodes multiply from the root down, and mirrors turn the winding") {
        Json model = triangle();
        model["nodes"] = {{{"children", {1}}, {"translation", {10, 0, 0}}},
                          {{"mesh", 0},
                           {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}},
                           {"scale", {1, 1, 1}}}};
        RawMesh mesh = load_model(model.dump());
        CHECK((mesh.positions[1] - Vec3(10, 1, 0)).norm() < 1e-12);
        CHECK(mesh.triangles[0] == Triangle{0, 1, 2});
        model["nodes"][1]["scale"] = {-1, 1, 1};
        mesh = load_model(model.dump());
        CHECK(mesh.triangles[0] == Triangle{0, 2, 1});
    }

    TEST_CASE("quantized and normalised positions are read as the extension says") {
        Json model = triangle();
        const std::string bytes = raw<std::int16_t>({0, 0, 0, 0, 32767, 0, 0, 0, 0, -32768, 0, 0}) +
                                  raw<std::uint16_t>({0, 1, 2});
        model["extensionsRequired"] = {"KHR_mesh_quantization"};
        model["accessors"][0] = {{"bufferView", 0},
                                 {"componentType", 5122},
                                 {"normalized", true},
                                 {"count", 3},
                                 {"type", "VEC3"}};
        model["bufferViews"][0] = {
            {"buffer", 0}, {"byteOffset", 0}, {"byteLength", 24}, {"byteStride", 8}};
        model["bufferViews"][1]["byteOffset"] = 24;
        model["buffers"][0] = {{"byteLength", bytes.size()},
                               {"uri", "data:application/octet-stream;base64," + base64(bytes)}};
        const RawMesh mesh = load_model(model.dump());
        CHECK(mesh.positions[1] == Vec3(1, 0, 0));
        CHECK(mesh.positions[2] == Vec3(0, -1, 0));
    }

    TEST_CASE("primitives of one node that share an accessor share its vertices") {
        Json model = triangle();
        model["meshes"][0]["primitives"].push_back(model["meshes"][0]["primitives"][0]);
        const RawMesh mesh = load_model(model.dump());
        CHECK(mesh.positions.size() == 3);
        CHECK(mesh.triangles.size() == 2);
    }

    TEST_CASE("a model without indices says so") {
        Json model = triangle();
        model["meshes"][0]["primitives"][0].erase("indices");
        CHECK_FALSE(load_model(model.dump()).indexed);
    }

    TEST_CASE("strips alternate their winding and drop repeated vertices") {
        Json model = triangle();
        const std::string bytes =
            raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}) + raw<std::uint16_t>({0, 1, 2, 3, 3});
        model["meshes"][0]["primitives"][0]["mode"] = 5;
        model["accessors"][0]["count"] = 4;
        model["accessors"][1]["count"] = 5;
        model["bufferViews"] = {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 48}},
                                {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 10}}};
        model["buffers"][0] = {{"byteLength", bytes.size()},
                               {"uri", "data:application/octet-stream;base64," + base64(bytes)}};
        const RawMesh mesh = load_model(model.dump());
        CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}});
    }

    TEST_CASE("what is not read is refused by name") {
        Json model = triangle();
        model["extensionsRequired"] = {"EXT_future_mesh"};
        CHECK(has(load_error(model.dump()),
                  "unsupported_model: glTF: requires the extension EXT_future_mesh"));
        model = triangle();
        model["buffers"][0]["uri"] = "../../etc/passwd";
        CHECK(has(load_error(model.dump()),
                  "unsupported_model: glTF: refers to another file, '../../etc/passwd'"));
        model = triangle();
        model["images"] = {{{"uri", "leather.png"}}};
        CHECK(has(load_error(model.dump()), "'leather.png'"));
    }

    TEST_CASE("what lies about its size or its links is refused") {
        Json model = triangle();
        model["accessors"][0]["count"] = 4;
        CHECK(has(load_error(model.dump()), "accessor 0 reaches past the end"));
        model = triangle();
        model["accessors"][0]["byteOffset"] = 18446744073709551600ULL;
        CHECK(has(load_error(model.dump()), "unreadable_model"));
        model = triangle();
        model["bufferViews"][0]["byteStride"] = 4;
        CHECK(has(load_error(model.dump()), "accessor 0"));
        model = triangle();
        model["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 7;
        CHECK(has(load_error(model.dump()), "accessor 7 does not exist"));
        model = triangle();
        model["nodes"][0]["children"] = {0};
        CHECK(has(load_error(model.dump()), "its own descendant"));
        CHECK(has(load_error("{\"a\":" + std::string(1000, '[')), "nested deeper"));
        CHECK(has(load_error("glTF\x02"), "ends inside its header"));
    }

    TEST_CASE("an index past the vertices is refused") {
        Json model = triangle();
        const std::string bytes =
            raw<float>({0, 0, 0, 1, 0, 0, 0, 2, 0}) + raw<std::uint16_t>({0, 1, 3});
        model["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(bytes);
        CHECK(has(load_error(model.dump()), "index 3 of accessor 1 is past its 3 vertices"));
    }

    TEST_CASE("a sparse accessor replaces what it names") {
        Json model = triangle();
        const std::string bytes =
            raw<float>({0, 0, 0, 1, 0, 0, 0, 2, 0, 7, 8, 9}) + raw<std::uint16_t>({0, 1, 2, 1});
        model["buffers"][0] = {{"uri", "data:application/octet-stream;base64," + base64(bytes)},
                               {"byteLength", bytes.size()}};
        model["bufferViews"] = {{{"buffer", 0}, {"byteLength", 36}},
                                {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 6}},
                                {{"buffer", 0}, {"byteOffset", 54}, {"byteLength", 2}},
                                {{"buffer", 0}, {"byteOffset", 36}, {"byteLength", 12}}};
        model["accessors"][0]["sparse"] = {
            {"count", 1},
            {"indices", {{"bufferView", 2}, {"componentType", 5123}}},
            {"values", {{"bufferView", 3}}}};
        CHECK(load_model(model.dump()).positions[1] == Vec3(7, 8, 9));
        model["accessors"][0]["sparse"]["count"] = 4;
        CHECK(has(load_error(model.dump()), "accessor 0 replaces more elements than it has"));
    }

    TEST_CASE("vertices without indices are counted when they are welded") {
        Json model = triangle();
        LoadLimits limits;
        limits.vertices = 2;
        CHECK(has(load_error(model.dump(), limits), "model_too_large"));
        model["meshes"][0]["primitives"][0].erase("indices");
        CHECK(load_model(model.dump(), limits).positions.size() == 3);
        limits.triangles = 0;
        CHECK(has(load_error(model.dump(), limits), "model_too_large"));
    }

    TEST_CASE("a position that is not finite is refused") {
        Json model = triangle();
        const std::string bytes =
            raw<float>({0, 0, 0, INFINITY, 0, 0, 0, 2, 0}) + raw<std::uint16_t>({0, 1, 2});
        model["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(bytes);
        CHECK(has(load_error(model.dump()), "mesh_degenerate"));
    }
}

}  // namespace lastflat
