#include "core/load/decode_draco.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
#include <draco/compression/decode.h>
#pragma GCC diagnostic pop

namespace lastflat {
namespace {

[[noreturn]] void fail_draco(const std::string& what,
                             ErrorCode code = ErrorCode::unreadable_model) {
    throw Error(code, "glTF: the Draco data " + what);
}

}  // namespace

DracoTriangles decode_draco(std::string_view bytes, int attribute, const LoadLimits& limits) {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) fail_draco("cannot be decoded: " + decoded.status().error_msg_string());
    const auto& mesh = *decoded.value();
    if (mesh.num_points() > limits.vertices || mesh.num_faces() > limits.triangles)
        fail_draco("holds more vertices or triangles than are read", ErrorCode::model_too_large);
    const auto* positions = mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(attribute));
    if (attribute < 0 || positions == nullptr || positions->num_components() != 3)
        fail_draco("has no positions under the id that the primitive names");
    DracoTriangles triangles;
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
        std::array<float, 3> xyz{};
        if (!positions->ConvertValue<float, 3>(positions->mapped_index(point), xyz.data()))
            fail_draco("has positions that are no numbers");
        triangles.positions.emplace_back(xyz[0], xyz[1], xyz[2]);
    }
    for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face) {
        for (const draco::PointIndex& corner : mesh.face(face)) {
            if (corner.value() >= mesh.num_points())
                fail_draco("names a vertex that it does not have");
            triangles.corners.push_back(static_cast<Index>(corner.value()));
        }
    }
    return triangles;
}

}  // namespace lastflat
