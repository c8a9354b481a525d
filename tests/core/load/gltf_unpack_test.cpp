#include "core/load/gltf_unpack.h"

#include <doctest/doctest.h>
#include <meshoptimizer.h>

#include <nlohmann/json.hpp>

#include "api/base64.h"
#include "core/load/gltf_guard.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#pragma GCC diagnostic pop

namespace lastflat {
namespace {

using Json = nlohmann::json;

constexpr float square[4][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 1}, {0, 2, 0}};

std::string glb(const Json& document, const std::string& bin) {
    std::string json = document.dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string padded = bin;
    padded.resize((bin.size() + 3) / 4 * 4, '\0');
    const auto number = [](std::size_t value) {
        const auto bits = static_cast<std::uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&bits), 4);
    };
    return "glTF" + number(2) + number(28 + json.size() + padded.size()) + number(json.size()) +
           "JSON" + json + number(padded.size()) + std::string("BIN\0", 4) + padded;
}

Json scene(const Json& primitive) {
    return {{"asset", {{"version", "2.0"}}},
            {"scene", 0},
            {"scenes", {{{"nodes", {0}}}}},
            {"nodes", {{{"mesh", 0}}}},
            {"meshes", {{{"primitives", {primitive}}}}}};
}

std::string packed_with_meshopt() {
    const unsigned corners[6] = {0, 1, 2, 0, 2, 3};
    std::string vertices(meshopt_encodeVertexBufferBound(4, 12), '\0');
    vertices.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(vertices.data()),
                                               vertices.size(), square, 4, 12));
    std::string indices(meshopt_encodeIndexBufferBound(6, 4), '\0');
    indices.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(indices.data()),
                                             indices.size(), corners, 6));
    const auto view = [](std::size_t offset, std::size_t size, std::size_t stride,
                         std::size_t count, const char* mode) {
        return Json{{"buffer", 1},
                    {"byteLength", stride * count},
                    {"extensions",
                     {{"EXT_meshopt_compression",
                       {{"buffer", 0},
                        {"byteOffset", offset},
                        {"byteLength", size},
                        {"byteStride", stride},
                        {"count", count},
                        {"mode", mode}}}}}};
    };
    Json document = scene({{"attributes", {{"POSITION", 0}}}, {"indices", 1}});
    document["extensionsRequired"] = {"EXT_meshopt_compression"};
    document["buffers"] = {{{"byteLength", vertices.size() + indices.size()}},
                           {{"byteLength", 72}}};
    document["bufferViews"] = {view(0, vertices.size(), 12, 4, "ATTRIBUTES"),
                               view(vertices.size(), indices.size(), 4, 6, "TRIANGLES")};
    document["accessors"] = {
        {{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
        {{"bufferView", 1}, {"componentType", 5125}, {"count", 6}, {"type", "SCALAR"}}};
    return glb(document, vertices + indices);
}

std::string packed_with_draco() {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    const int position =
        builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    builder.SetAttributeValuesForFace(position, draco::FaceIndex(0), square[0], square[1],
                                      square[2]);
    builder.SetAttributeValuesForFace(position, draco::FaceIndex(1), square[0], square[2],
                                      square[3]);
    const auto mesh = builder.Finalize();
    draco::Encoder encoder;
    draco::EncoderBuffer buffer;
    REQUIRE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    Json document = scene({{"attributes", {{"POSITION", 0}}},
                           {"indices", 1},
                           {"extensions",
                            {{"KHR_draco_mesh_compression",
                              {{"bufferView", 0}, {"attributes", {{"POSITION", 0}}}}}}}});
    document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    document["buffers"] = {{{"byteLength", buffer.size()}}};
    document["bufferViews"] = {{{"buffer", 0}, {"byteLength", buffer.size()}}};
    document["accessors"] = {{{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                             {{"componentType", 5125}, {"count", 6}, {"type", "SCALAR"}}};
    return glb(document, std::string(buffer.data(), buffer.size()));
}

/// The same as one document whose buffer is a data URI.
std::string document_of(const std::string& glb) {
    const std::string_view json = json_chunk(glb);
    const std::string bin =
        glb.substr(static_cast<std::size_t>(json.data() - glb.data()) + json.size() + 8);
    Json document = Json::parse(json);
    document["buffers"][0]["uri"] =
        "data:application/octet-stream;base64," + api::encode_base64(bin);
    return document.dump();
}

double area(const RawMesh& mesh) {
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const auto at = [&](std::size_t i) {
            return mesh.positions[static_cast<std::size_t>(t[i])];
        };
        const Vec3 a = at(1) - at(0), b = at(2) - at(0);
        sum +=
            0.5 * std::sqrt(std::max(0.0, a.squaredNorm() * b.squaredNorm() - a.dot(b) * a.dot(b)));
    }
    return sum;
}

}  // namespace

TEST_SUITE("core/load/gltf_unpack") {
    TEST_CASE("meshopt and Draco give the same square") {
        const std::string meshopt = packed_with_meshopt(), draco = packed_with_draco();
        for (const std::string& bytes :
             {meshopt, draco, document_of(meshopt), document_of(draco)}) {
            const RawMesh mesh = load_model(bytes);
            CHECK(mesh.triangles.size() == 2);
            CHECK(mesh.positions.size() == 4);
            CHECK(area(mesh) == doctest::Approx(2 * std::sqrt(5.0)));
        }
    }

    TEST_CASE("a compressed view of a buffer that is not there is refused") {
        Json document = Json::parse(document_of(packed_with_meshopt()));
        document["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["buffer"] = 1;
        CHECK_THROWS_WITH_AS((void)load_model(document.dump()),
                             doctest::Contains("reaches past the end of its buffer"), Error);
        document["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["buffer"] = 7;
        CHECK_THROWS_WITH_AS((void)load_model(document.dump()),
                             doctest::Contains("names no buffer"), Error);
        document["buffers"][0]["uri"] = "data:nonsense";
        CHECK_THROWS_AS((void)load_model(document.dump()), Error);
    }

    TEST_CASE("bytes that are cut off or changed are refused, never read") {
        for (const std::string& bytes : {packed_with_meshopt(), packed_with_draco()}) {
            const std::size_t bin = bytes.find("BIN") + 4;
            for (std::size_t at = bin; at < bytes.size(); ++at) {
                std::string changed = bytes;
                changed[at] = static_cast<char>(changed[at] ^ 0x55);
                try {
                    (void)load_model(changed);
                } catch (const Error&) {
                }
            }
            std::string far = bytes;
            const std::size_t offset = far.find("\"byteLength\":");
            far.replace(offset + 13, 1, "9");
            try {
                (void)load_model(far);
            } catch (const Error&) {
            }
        }
    }
}

}  // namespace lastflat
