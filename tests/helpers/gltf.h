// A small glTF to change in tests.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>

#include "api/base64.h"

namespace lastflat::test {

using Json = nlohmann::json;

inline std::string base64(const std::string& bytes) {
    return api::encode_base64(bytes);
}

template <class T>
std::string raw(std::initializer_list<T> values) {
    std::string bytes;
    for (const T value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    return bytes;
}

/// A triangle (0,0,0) (1,0,0) (0,2,0), indexed, in one node.
inline Json triangle() {
    const std::string bytes =
        raw<float>({0, 0, 0, 1, 0, 0, 0, 2, 0}) + raw<std::uint16_t>({0, 1, 2});
    return {{"asset", {{"version", "2.0"}}},
            {"scene", 0},
            {"scenes", {{{"nodes", {0}}}}},
            {"nodes", {{{"name", "foot"}, {"mesh", 0}}}},
            {"materials", {{{"name", "calf"}}}},
            {"meshes",
             {{{"name", "last"},
               {"primitives",
                {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"material", 0}}}}}}},
            {"accessors",
             {{{"bufferView", 0},
               {"componentType", 5126},
               {"count", 3},
               {"type", "VEC3"},
               {"min", {0, 0, 0}},
               {"max", {1, 2, 0}}},
              {{"bufferView", 1}, {"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}}}},
            {"bufferViews",
             {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 36}},
              {{"buffer", 0}, {"byteOffset", 36}, {"byteLength", 6}}}},
            {"buffers",
             {{{"byteLength", bytes.size()},
               {"uri", "data:application/octet-stream;base64," + base64(bytes)}}}}};
}

/// Appends an accessor of these bytes, with a buffer of its own; returns its index.
inline std::size_t add_accessor(Json& model, const std::string& bytes, const char* type,
                                int component_type, std::size_t count) {
    model["buffers"].push_back({{"byteLength", bytes.size()},
                                {"uri", "data:application/octet-stream;base64," + base64(bytes)}});
    model["bufferViews"].push_back(
        {{"buffer", model["buffers"].size() - 1}, {"byteLength", bytes.size()}});
    model["accessors"].push_back({{"bufferView", model["bufferViews"].size() - 1},
                                  {"componentType", component_type},
                                  {"count", count},
                                  {"type", type}});
    return model["accessors"].size() - 1;
}

}  // namespace lastflat::test
