#include <doctest/doctest.h>

#include <cstring>
#include <nlohmann/json.hpp>

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

    TEST_CASE("the flat GLB reads back, its texture coordinates are millimetres on the sheet") {
        const std::string glb = write_flat_glb(result());
        const RawMesh back = load_model(glb);
        CHECK((1000.0 * back.positions[7] - result().regions[0].region.positions[7]).norm() < 1e-4);
        CHECK(back.label_sets.front() == std::vector<std::string>{"lateral", "lateral"});
        std::uint32_t length = 0;
        std::memcpy(&length, glb.data() + 12, 4);
        const auto document = nlohmann::json::parse(glb.substr(20, length));
        const auto& attributes = document["meshes"][1]["primitives"][0]["attributes"];
        const auto& view =
            document["bufferViews"][document["accessors"][attributes["TEXCOORD_0"]
                                                              .get<std::size_t>()]["bufferView"]
                                        .get<std::size_t>()];
        float uv[2];
        std::memcpy(
            uv, glb.data() + 20 + length + 8 + view["byteOffset"].get<std::size_t>() + 8 * 5, 8);
        const Vec2 expected = result().sheet.placements[1].apply(result().regions[1].chart.uv[5]);
        CHECK(uv[0] == doctest::Approx(expected.x()).epsilon(1e-6));
        CHECK(uv[1] == doctest::Approx(expected.y()).epsilon(1e-6));
        CHECK(document["scenes"][0]["extras"]["sheet_mm"][0].get<double>() ==
              doctest::Approx(result().sheet.width));
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
