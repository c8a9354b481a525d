#include <doctest/doctest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "core/export/write_flat_glb.h"
#include "core/export/write_model.h"
#include "core/load/load_model.h"
#include "tests/helpers/sample.h"

namespace lastflat {
namespace {

const FlattenResult& result() {
    static const SampleLast last = make_sample_last();
    static const FlattenResult flat = test::flatten_sample(last, test::sample_options(last));
    return flat;
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++n;
    return n;
}

using Json = nlohmann::json;

/// A GLB of ours, taken apart.
struct FlatScene {
    Json document;
    std::string buffer;

    explicit FlatScene(const std::string& glb) {
        std::uint32_t length = 0;
        std::memcpy(&length, glb.data() + 12, 4);
        document = Json::parse(glb.substr(20, length));
        buffer = glb.substr(20 + length + 8);
    }
    /// Entry `i` of an accessor of so many floats each.
    [[nodiscard]] std::vector<double> floats(const Json& accessor, std::size_t width,
                                             std::size_t i) const {
        const Json& view =
            document["bufferViews"][document["accessors"][accessor.get<std::size_t>()]["bufferView"]
                                        .get<std::size_t>()];
        std::vector<float> values(width);
        std::memcpy(values.data(),
                    buffer.data() + view["byteOffset"].get<std::size_t>() + 4 * width * i,
                    4 * width);
        return {values.begin(), values.end()};
    }
};

}  // namespace

TEST_SUITE("core/export") {
    TEST_CASE("the flat OBJ reads back as the regions, on the last") {
        const RawMesh back = load_model(write_flat_obj(result()));
        std::size_t vertices = 0, triangles = 0;
        for (const auto& flat : result().regions) {
            vertices += flat.region.positions.size();
            triangles += flat.region.triangles.size();
        }
        CHECK(back.positions.size() == vertices);
        CHECK(back.triangles.size() == triangles);
        CHECK(back.label_sets.front() == std::vector<std::string>{"lateral"});
        CHECK((back.positions[7] - result().regions[0].region.positions[7]).norm() < 1e-6);
        CHECK(count(write_flat_obj(result()), "\nvt ") == vertices);
    }

    TEST_CASE("the flat GLB reads back, upright, its texture coordinates shares of the sheet") {
        const std::string glb = write_flat_glb(result());
        const RawMesh back = load_model(glb);
        const Vec3 on_last = result().regions[0].region.positions[7];  // z is up
        CHECK((1000.0 * back.positions[7] - Vec3(on_last.x(), on_last.z(), -on_last.y())).norm() <
              1e-4);
        CHECK(back.label_sets.front() ==
              std::vector<std::string>{"last", "lateral", "lateral", "leather"});
        const FlatScene scene(glb);
        const Json& primitive = scene.document["meshes"][1]["primitives"][0];
        const Sheet& sheet = result().sheet;
        const Vec2 placed = sheet.placements[1].apply(result().regions[1].chart.uv[5]);
        const auto uv = scene.floats(primitive["attributes"]["TEXCOORD_0"], 2, 5);
        CHECK(uv[0] == doctest::Approx(placed.x() / sheet.width).epsilon(1e-6));
        CHECK(uv[1] == doctest::Approx(1.0 - placed.y() / sheet.height).epsilon(1e-6));
        CHECK(scene.document["asset"]["extras"]["sheet_mm"][1].get<double>() ==
              doctest::Approx(sheet.height));
        const auto normal = scene.floats(primitive["attributes"]["NORMAL"], 3, 5);
        CHECK(std::hypot(normal[0], normal[1], normal[2]) == doctest::Approx(1.0).epsilon(1e-6));
    }

    TEST_CASE("the morph target lays the pieces on the ground, as far apart as on the sheet") {
        const FlatScene scene(write_flat_glb(result()));
        for (std::size_t r = 0; r < 2; ++r) {
            const Json& primitive = scene.document["meshes"][r]["primitives"][0];
            const auto flat = [&](std::size_t v) {
                const auto there = scene.floats(primitive["attributes"]["POSITION"], 3, v);
                const auto way = scene.floats(primitive["targets"][0]["POSITION"], 3, v);
                return Vec3(1000.0 * (there[0] + way[0]), 1000.0 * (there[1] + way[1]),
                            1000.0 * (there[2] + way[2]));
            };
            const Points2& uv = result().regions[r].chart.uv;
            for (const std::size_t v : {1u, 17u, 300u}) {
                CHECK((flat(v) - flat(0)).norm() ==
                      doctest::Approx((uv[v] - uv[0]).norm()).epsilon(1e-4));
                CHECK(flat(v).z() == doctest::Approx(flat(0).z()).epsilon(1e-5));
            }
        }
    }

    TEST_CASE("a model's OBJ and GLB say the same") {
        const SampleLast last = make_sample_last();
        const RawMesh obj = load_model(write_model_obj(last.mesh)),
                      glb = load_model(write_model_glb(last.mesh));
        REQUIRE(obj.positions.size() == glb.positions.size());
        CHECK(obj.triangles.size() == glb.triangles.size());
        for (std::size_t v = 0; v < obj.positions.size(); ++v) {
            CHECK(obj.positions[v] == last.mesh.positions[v]);
            CHECK((1000.0 * glb.positions[v] - obj.positions[v]).norm() < 5e-5);
        }
    }
}

}  // namespace lastflat
