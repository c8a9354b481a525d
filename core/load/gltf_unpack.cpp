#include "core/load/gltf_unpack.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "core/load/byte_order.h"
#include "core/load/decode_draco.h"
#include "core/load/gltf_guard.h"
#include "core/load/tinygltf.h"

namespace lastflat {
namespace {

using Json = nlohmann::json;
constexpr const char* meshopt = "EXT_meshopt_compression";
constexpr const char* draco = "KHR_draco_mesh_compression";

[[noreturn]] void fail_unpacking(const std::string& what,
                                 ErrorCode code = ErrorCode::unreadable_model) {
    throw Error(code, "glTF: compressed data: " + what);
}

std::size_t number(const Json& object, const char* name, std::size_t absent = 0) {
    const auto found = object.find(name);
    if (found == object.end()) return absent;
    if (!found->is_number_unsigned()) fail_unpacking(std::string(name) + " is no count");
    return found->get<std::size_t>();
}

std::string text(const Json& object, const char* name) {
    const auto found = object.find(name);
    if (found == object.end()) return "NONE";
    return found->is_string() ? found->get<std::string>() : "";
}

void undo_filter(const std::string& filter, std::string& bytes, std::size_t count,
                 std::size_t stride) {
    if (filter == "NONE") return;
    if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) {
        meshopt_decodeFilterOct(bytes.data(), count, stride);
    } else if (filter == "QUATERNION" && stride == 8) {
        meshopt_decodeFilterQuat(bytes.data(), count, stride);
    } else if (filter == "EXPONENTIAL" && stride % 4 == 0) {
        meshopt_decodeFilterExp(bytes.data(), count, stride);
    } else {
        fail_unpacking("the filter '" + filter.substr(0, 40) + "' is not known for this stride",
                       ErrorCode::unsupported_model);
    }
}

/// One compressed view, decoded.
std::string decoded(const Json& view, std::string_view packed, std::size_t most_bytes) {
    const std::size_t stride = number(view, "byteStride"), count = number(view, "count");
    if (stride == 0 || stride > 256 || count == 0 || count > most_bytes / stride)
        fail_unpacking("a view has a count or a stride that it cannot have",
                       ErrorCode::model_too_large);
    const auto* data = reinterpret_cast<const unsigned char*>(packed.data());
    const std::size_t length = packed.size();
    const std::string mode = text(view, "mode");
    std::string bytes(count * stride, '\0');
    int status = -1;
    if (mode == "ATTRIBUTES" && stride % 4 == 0) {
        status = meshopt_decodeVertexBuffer(bytes.data(), count, stride, data, length);
        if (status == 0) undo_filter(text(view, "filter"), bytes, count, stride);
    } else if (mode == "TRIANGLES" && count % 3 == 0 && (stride == 2 || stride == 4)) {
        status = meshopt_decodeIndexBuffer(bytes.data(), count, stride, data, length);
    } else if (mode == "INDICES" && (stride == 2 || stride == 4)) {
        status = meshopt_decodeIndexSequence(bytes.data(), count, stride, data, length);
    } else {
        fail_unpacking("the mode '" + mode.substr(0, 40) + "' is not known for this stride",
                       ErrorCode::unsupported_model);
    }
    if (status != 0) fail_unpacking("a view cannot be decoded");
    return bytes;
}

std::string_view bin_chunk(std::string_view glb, std::string_view json) {
    const std::size_t at = static_cast<std::size_t>(json.data() - glb.data()) + json.size();
    if (glb.size() - at < 8) return {};
    const auto length = read_unsigned<std::uint32_t>(glb.substr(at), ByteOrder::little);
    if (length > glb.size() - at - 8) fail_unpacking("the BIN chunk is cut off");
    return glb.substr(at + 8, length);
}

void append_u32(std::string& bytes, std::size_t value) {
    for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<char>(value >> 8 * i & 0xFF));
}

void append_float(std::string& bytes, double number) {
    append_u32(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(number)));
}

std::string glb_of(std::string json, std::string bin) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    bin.resize((bin.size() + 3) / 4 * 4, '\0');
    std::string glb = "glTF";
    append_u32(glb, 2);
    append_u32(glb, 28 + json.size() + bin.size());
    append_u32(glb, json.size());
    glb += "JSON" + json;
    append_u32(glb, bin.size());
    glb.append("BIN\0", 4).append(bin);
    return glb;
}

/// The bytes of a buffer that the document itself holds; one without a URI stands for what the
/// compressed views hold, and has none.
std::vector<unsigned char> embedded(const Json& buffer) {
    std::vector<unsigned char> bytes;
    std::string type;
    if (!buffer.contains("uri")) return bytes;
    if (!tinygltf::DecodeDataURI(&bytes, type, text(buffer, "uri"), 0, false))
        fail_unpacking("a buffer's data URI cannot be decoded");
    return bytes;
}

/// The document and its buffers, joined to one, while the extensions are taken out of them.
class Unpacker {
public:
    /// `bin`: the buffer that a GLB holds beside the document.
    Unpacker(std::string_view json, std::optional<std::string_view> bin, const LoadLimits& limits)
        : document_(Json::parse(json)),
          limits_(limits),
          // More for each vertex and triangle than any attribute that is read.
          room_(256 * (limits.vertices + limits.triangles)) {
        for (const Json& buffer : list("buffers")) {
            if (!buffer.is_object()) fail_unpacking("a buffer is no object");
            const bool is_bin = bin && buffers_.empty() && !buffer.contains("uri");
            const std::size_t begin = bin_.size();
            if (is_bin) {
                bin_ += *bin;
            } else {
                const auto bytes = embedded(buffer);
                bin_.append(bytes.begin(), bytes.end());
            }
            buffers_.push_back({begin, bin_.size() - begin});
            bin_.resize((bin_.size() + 3) / 4 * 4, '\0');
        }
    }

    std::string unpacked() {
        for (Json& view : list("bufferViews")) unpack_view(view);
        document_["buffers"] = Json::array({{{"byteLength", bin_.size()}}});
        for (Json& mesh : list("meshes")) {
            if (!mesh.is_object() || !mesh.contains("primitives")) continue;
            for (Json& primitive : mesh["primitives"]) unpack_primitive(primitive);
        }
        document_["buffers"][0]["byteLength"] = bin_.size();
        Json& required = document_["extensionsRequired"];
        for (const char* extension : {meshopt, draco})
            required.erase(std::remove(required.begin(), required.end(), extension),
                           required.end());
        if (required.empty()) document_.erase("extensionsRequired");
        return glb_of(document_.dump(-1, ' ', false, Json::error_handler_t::replace),
                      std::move(bin_));
    }

private:
    Json& list(const char* name) {
        Json& found = document_[name];
        if (!found.is_array()) fail_unpacking(std::string("there are no ") + name);
        return found;
    }
    static Json* extension_of(Json& object, const char* name) {
        if (!object.is_object() || !object.contains("extensions")) return nullptr;
        Json& extensions = object["extensions"];
        return extensions.is_object() && extensions.contains(name) ? &extensions[name] : nullptr;
    }

    /// Where the bytes begin in the buffer.
    std::size_t append(std::string_view bytes) {
        if (bytes.size() > room_)
            fail_unpacking("more than can be read", ErrorCode::model_too_large);
        room_ -= bytes.size();
        bin_.resize((bin_.size() + 3) / 4 * 4, '\0');
        const std::size_t begin = bin_.size();
        bin_ += bytes;
        return begin;
    }

    struct Part {
        std::size_t begin, size;
    };

    /// Where the bytes of a view are in the one buffer.
    [[nodiscard]] Part part_of(const Json& view) const {
        const std::size_t b = number(view, "buffer", buffers_.size());
        if (b >= buffers_.size()) fail_unpacking("a view names no buffer");
        const std::size_t offset = number(view, "byteOffset"), length = number(view, "byteLength");
        if (offset > buffers_[b].size || length > buffers_[b].size - offset)
            fail_unpacking("a view reaches past the end of its buffer");
        return {buffers_[b].begin + offset, length};
    }

    void unpack_view(Json& view) {
        if (!view.is_object()) fail_unpacking("a buffer view is no object");
        const Json* packed = extension_of(view, meshopt);
        if (packed == nullptr) {
            view["byteOffset"] = part_of(view).begin;
            view["buffer"] = 0;
            return;
        }
        const Part part = part_of(*packed);
        const std::string bytes =
            decoded(*packed, std::string_view(bin_).substr(part.begin, part.size), room_);
        view["buffer"] = 0;
        view["byteOffset"] = append(bytes);
        view["byteLength"] = bytes.size();
        view.erase("extensions");
    }

    void unpack_primitive(Json& primitive) {
        Json* packed = extension_of(primitive, draco);
        if (packed == nullptr) return;
        const std::size_t v = number(*packed, "bufferView", document_["bufferViews"].size());
        if (v >= document_["bufferViews"].size())
            fail_unpacking("a primitive names no buffer view");
        const Json& view = document_["bufferViews"][v];
        const std::size_t offset = number(view, "byteOffset"), length = number(view, "byteLength");
        if (offset > bin_.size() || length > bin_.size() - offset)
            fail_unpacking("a view reaches past the end of its buffer");
        const Json attributes = packed->value("attributes", Json::object());
        const DracoTriangles decoded =
            decode_draco(std::string_view(bin_).substr(offset, length),
                         static_cast<int>(number(attributes, "POSITION", 1u << 20)), limits_);
        std::string positions, corners;
        for (const Vec3& position : decoded.positions) {
            for (const double coordinate : position) append_float(positions, coordinate);
        }
        for (const Index corner : decoded.corners)
            append_u32(corners, static_cast<std::size_t>(corner));
        constexpr int as_float = 5126, as_u32 = 5125;
        primitive["attributes"] = {
            {"POSITION", add_accessor(positions, "VEC3", as_float, decoded.positions.size())}};
        primitive["indices"] = add_accessor(corners, "SCALAR", as_u32, decoded.corners.size());
        primitive["mode"] = 4;
        primitive.erase("extensions");
    }

    std::size_t add_accessor(const std::string& bytes, const char* type, int component,
                             std::size_t count) {
        const std::size_t begin = append(bytes);
        Json& views = document_["bufferViews"];
        views.push_back({{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes.size()}});
        Json& accessors = list("accessors");
        accessors.push_back({{"bufferView", views.size() - 1},
                             {"componentType", component},
                             {"count", count},
                             {"type", type}});
        return accessors.size() - 1;
    }

    Json document_;
    const LoadLimits& limits_;
    std::size_t room_;
    std::string bin_;
    std::vector<Part> buffers_;  ///< as they were
};

}  // namespace

bool is_packed_gltf(std::string_view json) {
    const Json document = Json::parse(json, nullptr, false);
    const auto required = document.find("extensionsRequired");
    return required != document.end() &&
           std::any_of(required->begin(), required->end(),
                       [](const Json& name) { return name == meshopt || name == draco; });
}

std::string unpack_gltf(std::string_view json, const LoadLimits& limits) {
    return Unpacker(json, std::nullopt, limits).unpacked();
}

std::string unpack_glb(std::string_view glb, const LoadLimits& limits) {
    const std::string_view json = json_chunk(glb);
    return Unpacker(json, bin_chunk(glb, json), limits).unpacked();
}

}  // namespace lastflat
