#include "core/load/load_model.h"

#include "core/load/first_bytes.h"
#include "core/load/read_gltf.h"
#include "core/load/read_obj.h"
#include "core/load/read_ply.h"
#include "core/load/read_stl.h"

namespace lastflat {
namespace {

std::string_view without_byte_order_mark(std::string_view bytes) {
    return bytes.starts_with("\xEF\xBB\xBF") ? bytes.substr(3) : bytes;
}

char first_visible(std::string_view bytes) {
    const auto i = bytes.find_first_not_of(" \t\r\n");
    return i == std::string_view::npos ? '\0' : bytes[i];
}

}  // namespace

RawMesh load_model(std::string_view bytes, const LoadLimits& limits) {
    const auto with_seams = [](RawMesh mesh) {
        mesh.repeats_at_seams = true;
        return mesh;
    };
    check_first_bytes(bytes);
    if (bytes.starts_with("glTF")) return with_seams(read_glb(bytes, limits));
    const std::string_view text = without_byte_order_mark(bytes);
    if (first_visible(text) == '{') return with_seams(read_gltf(text, limits));
    if (text.starts_with("ply\n") || text.starts_with("ply\r"))
        return with_seams(read_ply(text, limits));
    if (is_stl(text)) return read_stl(text, limits);
    return read_obj(text, limits);
}

}  // namespace lastflat
