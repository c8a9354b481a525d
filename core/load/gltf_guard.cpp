#include "core/load/gltf_guard.h"

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/utf8.h"

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

/// Whether an extension, VENDOR_kind, is of a kind that leaves the triangles as they are.
bool leaves_triangles(std::string_view extension) {
    constexpr std::array<std::string_view, 8> kinds{
        "texture", "materials", "techniques",    "lights",
        "xmp",     "packing",   "mesh_features", "instance_features"};
    const auto vendor_end = extension.find('_');
    if (vendor_end == std::string_view::npos) return false;
    const std::string_view kind = extension.substr(vendor_end + 1);
    return kind.ends_with("metadata") ||
           std::any_of(kinds.begin(), kinds.end(),
                       [&](std::string_view known) { return kind.starts_with(known); });
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
        constexpr std::array<std::string_view, 4> read{
            "KHR_mesh_quantization", "KHR_draco_mesh_compression", "EXT_meshopt_compression",
            "KHR_animation_pointer"};
        if (contains(read, name) || leaves_triangles(name)) continue;
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

/// `object` describes values of a sparse accessor; the general reader keeps 32 bits of its numbers.
void guard_sparse_numbers(const Json& object, const std::string& accessor) {
    for (const auto& [name, value] : object.items()) {
        constexpr std::uint64_t largest = std::numeric_limits<std::int32_t>::max();
        if (!value.is_number()) continue;
        if (value.is_number_unsigned() && value.get<std::uint64_t>() <= largest) continue;
        refuse(ErrorCode::unreadable_model,
               accessor + " is sparse, with an impossible " + name.substr(0, 40));
    }
}

void guard_sparse_accessors(const Json& document) {
    const auto accessors = document.find("accessors");
    if (accessors == document.end() || !accessors->is_array()) return;
    for (std::size_t a = 0; a < accessors->size(); ++a) {
        const Json& accessor = (*accessors)[a];
        if (!accessor.is_object() || !accessor.contains("sparse")) continue;
        const Json& sparse = accessor["sparse"];
        guard_sparse_numbers(sparse, "accessor " + std::to_string(a));
        for (const Json& part : sparse) guard_sparse_numbers(part, "accessor " + std::to_string(a));
    }
}

/// Strings that are not UTF-8, each read as Latin-1. A quote is no part of a longer character.
std::string with_utf8_strings(std::string_view json) {
    std::string result;
    while (!json.empty()) {
        const std::string_view part = json.substr(0, json.find('"', 1));
        result += as_utf8(part);
        json.remove_prefix(part.size());
    }
    return result;
}

std::uint32_t read_u32(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) {
        value = value * 256 + static_cast<unsigned char>(bytes[at + i]);
    }
    return value;
}

}  // namespace

std::optional<std::string> guard_gltf(std::string_view json, const LoadLimits& limits) {
    if (!is_utf8(json)) {
        const std::string text = with_utf8_strings(json);
        return guard_gltf(text, limits).value_or(text);
    }
    guard_depth(json, limits.json_depth);
    Json document = Json::parse(json, nullptr, false);
    if (!document.is_object()) refuse(ErrorCode::unreadable_model, "the JSON is not well-formed");
    guard_extensions(document);
    guard_files(document, "buffers");
    guard_files(document, "images");
    guard_sparse_accessors(document);
    if (document.erase("images") == 0) return std::nullopt;
    return document.dump();
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

std::string with_json_chunk(std::string_view glb, std::string json) {
    const auto number = [](std::size_t value) {
        std::string bytes;
        for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i & 0xFF);
        return bytes;
    };
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::size_t begin = 20 + std::size_t{read_u32(glb, 12)};
    const std::size_t end = std::max<std::size_t>(begin, read_u32(glb, 8));
    const std::string_view rest = glb.substr(begin, end - begin);
    return std::string(glb.substr(0, 8)) + number(20 + json.size() + rest.size()) +
           number(json.size()) + "JSON" + json + std::string(rest);
}

}  // namespace lastflat
