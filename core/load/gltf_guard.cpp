#include "core/load/gltf_guard.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace lastflat {
namespace {

using Json = nlohmann::json;

[[noreturn]] void refuse(ErrorCode code, const std::string& what) {
    throw Error(code, "glTF: " + what);
}

/// Counts brackets outside strings; general readers recurse on what they enclose.
void guard_depth(std::string_view json, std::size_t limit) {
    std::size_t depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (in_string) {
            if (c == '\\') ++i;
            if (c == '"') in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > limit) {
                refuse(ErrorCode::unreadable_model,
                       "nested deeper than " + std::to_string(limit) + " levels");
            }
        } else if ((c == '}' || c == ']') && depth > 0) {
            --depth;
        }
    }
}

void guard_extensions(const Json& document) {
    const auto required = document.find("extensionsRequired");
    if (required == document.end()) return;
    if (!required->is_array()) refuse(ErrorCode::unreadable_model, "extensionsRequired is no list");
    for (const Json& extension : *required) {
        if (!extension.is_string()) {
            refuse(ErrorCode::unreadable_model,
                   "extensionsRequired holds something else than names");
        }
        const auto name = extension.get<std::string>();
        constexpr std::array<std::string_view, 5> known{
            "KHR_mesh_quantization", "KHR_draco_mesh_compression", "EXT_meshopt_compression",
            "KHR_materials_unlit", "KHR_texture_transform"};
        if (contains(known, name)) continue;
        refuse(ErrorCode::unsupported_model,
               "requires the extension " + name.substr(0, 80) +
                   ", which this version does not read; export without it");
    }
}

void guard_files(const Json& document, const char* list) {
    const auto items = document.find(list);
    if (items == document.end()) return;
    if (!items->is_array()) refuse(ErrorCode::unreadable_model, std::string(list) + " is no list");
    for (const Json& item : *items) {
        if (!item.is_object()) {
            refuse(ErrorCode::unreadable_model,
                   std::string(list) + " holds something else than objects");
        }
        const auto uri = item.find("uri");
        if (uri == item.end()) continue;
        if (!uri->is_string()) refuse(ErrorCode::unreadable_model, "a uri is no string");
        const auto& text = uri->get_ref<const std::string&>();
        if (text.rfind("data:", 0) == 0) continue;
        refuse(ErrorCode::unsupported_model,
               "refers to another file, '" + text.substr(0, 80) +
                   "'; send one self-contained file (GLB, or glTF with data URIs)");
    }
}

std::uint32_t read_u32(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) {
        value = value * 256 + static_cast<unsigned char>(bytes[at + i]);
    }
    return value;
}

}  // namespace

void guard_gltf(std::string_view json, const LoadLimits& limits) {
    guard_depth(json, limits.json_depth);
    const Json document = Json::parse(json, nullptr, false);
    if (!document.is_object()) refuse(ErrorCode::unreadable_model, "the JSON is not well-formed");
    guard_extensions(document);
    guard_files(document, "buffers");
    guard_files(document, "images");
}

std::string_view json_chunk(std::string_view glb) {
    if (glb.size() < 20) refuse(ErrorCode::unreadable_model, "the GLB ends inside its header");
    if (read_u32(glb, 4) != 2) {
        refuse(ErrorCode::unsupported_model,
               "GLB container version " + std::to_string(read_u32(glb, 4)) + "; version 2 is read");
    }
    const std::uint32_t total = read_u32(glb, 8);
    const std::uint32_t length = read_u32(glb, 12);
    if (total > glb.size() || length > glb.size() - 20 || read_u32(glb, 16) != 0x4E4F534A) {
        refuse(ErrorCode::unreadable_model,
               "the GLB announces " + std::to_string(total) + " bytes with a JSON chunk of " +
                   std::to_string(length) + ", but has " + std::to_string(glb.size()));
    }
    return glb.substr(20, length);
}

}  // namespace lastflat
