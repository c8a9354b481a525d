#include "core/load/gltf_guard.h"

#include <doctest/doctest.h>

#include "tests/helpers/errors.h"
#include "tests/helpers/gltf.h"

namespace lastflat {
namespace {

using test::has;
using test::load_error;
using test::triangle;

/// A GLB without a BIN chunk.
std::string container(std::string json) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const auto size = static_cast<std::uint32_t>(json.size());
    return "glTF" + test::raw<std::uint32_t>({2, 20 + size, size}) + "JSON" + json;
}

}  // namespace

TEST_SUITE("core/load/gltf_guard") {
    TEST_CASE("required extensions that leave the triangles as they are do not matter") {
        for (const char* name :
             {"KHR_texture_basisu", "EXT_texture_webp", "MSFT_texture_dds", "KHR_texture_transform",
              "KHR_materials_unlit", "KHR_materials_variants", "KHR_lights_punctual",
              "KHR_xmp_json_ld", "EXT_mesh_features", "EXT_structural_metadata"}) {
            CAPTURE(name);
            test::Json model = triangle();
            model["extensionsRequired"] = {name};
            CHECK(load_model(model.dump()).triangles.size() == 1);
        }
    }

    TEST_CASE("those that may change them are refused by name") {
        for (const char* name : {"EXT_mesh_gpu_instancing", "KHR_meshopt_compression",
                                 "KHR_node_visibility", "texture", "MSFT_lod"}) {
            CAPTURE(name);
            test::Json model = triangle();
            model["extensionsRequired"] = {name};
            CHECK(has(load_error(model.dump()), "requires the extension " + std::string(name)));
        }
    }

    TEST_CASE("images of any type are left out") {
        test::Json model = triangle();
        model["images"] = {{{"uri", "data:image/ktx2;base64,AAAA"}}, {{"bufferView", 77}}};
        model["textures"] = {{{"source", 0}}};
        CHECK(load_model(model.dump()).triangles.size() == 1);
        CHECK(load_model(container(model.dump())).triangles.size() == 1);
    }

    TEST_CASE("names that are no UTF-8 are Latin-1, and the others stay as they are") {
        test::Json model = triangle();
        model["nodes"][0]["name"] = "@";
        model["meshes"][0]["name"] =
            "au\xc3\x9f"
            "en";
        std::string json = model.dump();
        json.replace(json.find("\"@\""), 3,
                     "\"au\xdf"
                     "en\"");
        for (const std::string& bytes : {json, container(json)}) {
            const RawMesh mesh = load_model(bytes);
            CHECK(mesh.label_sets[0] == std::vector<std::string>{"au\xc3\x9f"
                                                                 "en",
                                                                 "au\xc3\x9f"
                                                                 "en",
                                                                 "calf"});
        }
    }

    TEST_CASE("numbers of sparse accessors that do not fit 32 bits are refused") {
        for (const std::uint64_t count : {2147483648ULL, 4294967297ULL, 18446744073709551615ULL}) {
            test::Json model = triangle();
            model["accessors"][0]["sparse"] = {
                {"count", count},
                {"indices", {{"bufferView", 1}, {"componentType", 5123}}},
                {"values", {{"bufferView", 0}}}};
            CHECK(has(load_error(model.dump()), "accessor 0 is sparse, with an impossible count"));
            model["accessors"][0]["sparse"]["count"] = 1;
            CHECK(load_model(model.dump()).triangles.size() == 1);
            model["accessors"][0]["sparse"]["values"]["byteOffset"] = count;
            CHECK(has(load_error(model.dump()), "impossible byteOffset"));
        }
    }
}

}  // namespace lastflat
