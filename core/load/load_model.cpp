#include "core/load/load_model.h"

#include "core/load/read_gltf.h"
#include "core/load/read_obj.h"
#include "core/load/read_ply.h"
#include "core/load/read_stl.h"

namespace lastflat {
namespace {

bool starts_with(std::string_view bytes, std::string_view start) {
    return bytes.substr(0, start.size()) == start;
}

std::string_view without_byte_order_mark(std::string_view bytes) {
    return starts_with(bytes, "\xEF\xBB\xBF") ? bytes.substr(3) : bytes;
}

char first_visible(std::string_view bytes) {
    const auto i = bytes.find_first_not_of(" \t\r\n");
    return i == std::string_view::npos ? '\0' : bytes[i];
}

/// The name of a known format that is not read, or nothing.
std::string_view unread_format(std::string_view bytes) {
    if (starts_with(bytes, "\xFF\xFE") || starts_with(bytes, "\xFE\xFF")) return "UTF-16 text";
    if (starts_with(bytes, "OFF") || starts_with(bytes, "COFF")) return "OFF";
    if (starts_with(bytes, "PK\x03\x04")) return "ZIP";
    if (starts_with(bytes, "\x1F\x8B")) return "gzip";
    if (starts_with(bytes, "ISO-10303-21")) return "STEP";
    if (starts_with(bytes, "3D Geometry File Format")) return "Rhino 3DM";
    return {};
}

}  // namespace

RawMesh load_model(std::string_view bytes, const LoadLimits& limits) {
    const auto with_seams = [](RawMesh mesh) {
        mesh.repeats_at_seams = true;
        return mesh;
    };
    if (bytes.empty()) throw Error(ErrorCode::unreadable_model, "the model is empty (0 bytes)");
    if (starts_with(bytes, "glTF")) return with_seams(read_glb(bytes, limits));
    if (const auto format = unread_format(bytes); !format.empty()) {
        throw Error(ErrorCode::unsupported_model,
                    "the model is " + std::string(format) +
                        ", which this version does not read; send OBJ, STL, PLY, glTF or GLB");
    }
    const std::string_view text = without_byte_order_mark(bytes);
    if (first_visible(text) == '{') return with_seams(read_gltf(text, limits));
    if (starts_with(text, "ply\n") || starts_with(text, "ply\r"))
        return with_seams(read_ply(text, limits));
    if (is_stl(text)) return read_stl(text, limits);
    return read_obj(text, limits);
}

}  // namespace lastflat
