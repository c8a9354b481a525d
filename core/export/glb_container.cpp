#include "core/export/glb_container.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>

namespace lastflat {
namespace {

using Json = nlohmann::ordered_json;

constexpr int float_component = 5126, uint_component = 5125;
constexpr int no_target = 0, vertex_buffer = 34962, index_buffer = 34963;

template <class T>
void append(std::string& bytes, T value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);  // glTF and every machine we build for: little endian
    bytes.append(raw, sizeof value);
}

void append_chunk(std::string& bytes, std::uint32_t type, std::string content, char padding) {
    content.resize((content.size() + 3) / 4 * 4, padding);
    append(bytes, static_cast<std::uint32_t>(content.size()));
    append(bytes, type);
    bytes += content;
}

}  // namespace

GlbContainer::GlbContainer() {
    document_["asset"] = {{"version", "2.0"}, {"generator", "lastflat"}};
    for (const char* list : {"scenes", "nodes", "meshes", "accessors", "bufferViews"}) {
        document_[list] = Json::array();
    }
    document_["scene"] = 0;
}

std::size_t GlbContainer::add_accessor(const char* type, int component_type, std::size_t count,
                                       std::size_t bytes, int target) {
    Json view{{"buffer", 0}, {"byteOffset", buffer_.size() - bytes}, {"byteLength", bytes}};
    if (target != 0) view["target"] = target;
    document_["bufferViews"].push_back(std::move(view));
    document_["accessors"].push_back({{"bufferView", document_["bufferViews"].size() - 1},
                                      {"componentType", component_type},
                                      {"count", count},
                                      {"type", type}});
    return document_["accessors"].size() - 1;
}

void GlbContainer::append_floats(const Points3& vectors) {
    for (const Vec3& v : vectors) {
        for (const double value : v) append(buffer_, static_cast<float>(value));
    }
}

std::size_t GlbContainer::add_positions(const Points3& points) {
    Eigen::AlignedBox3f box;
    for (const Vec3& p : points) box.extend(p.cast<float>());
    const std::size_t accessor = add_directions(points);
    document_["accessors"][accessor]["min"] = {box.min().x(), box.min().y(), box.min().z()};
    document_["accessors"][accessor]["max"] = {box.max().x(), box.max().y(), box.max().z()};
    return accessor;
}

std::size_t GlbContainer::add_directions(const Points3& vectors) {
    append_floats(vectors);
    return add_accessor("VEC3", float_component, vectors.size(), 12 * vectors.size(),
                        vertex_buffer);
}

std::size_t GlbContainer::add_scalars(const std::vector<double>& values) {
    for (const double value : values) append(buffer_, static_cast<float>(value));
    const auto accessor =
        add_accessor("SCALAR", float_component, values.size(), 4 * values.size(), no_target);
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    document_["accessors"][accessor]["min"] = {*least};
    document_["accessors"][accessor]["max"] = {*most};
    return accessor;
}

std::size_t GlbContainer::add_texture_coordinates(const Points2& points) {
    for (const Vec2& p : points) {
        append(buffer_, static_cast<float>(p.x()));
        append(buffer_, static_cast<float>(p.y()));
    }
    return add_accessor("VEC2", float_component, points.size(), 8 * points.size(), vertex_buffer);
}

std::size_t GlbContainer::add_indices(const std::vector<Triangle>& triangles) {
    for (const Triangle& t : triangles) {
        for (const Index v : t) append(buffer_, static_cast<std::uint32_t>(v));
    }
    return add_accessor("SCALAR", uint_component, 3 * triangles.size(), 12 * triangles.size(),
                        index_buffer);
}

std::size_t GlbContainer::add_ids(const std::vector<Index>& ids) {
    for (const Index id : ids) append(buffer_, static_cast<std::uint32_t>(id));
    return add_accessor("SCALAR", uint_component, ids.size(), 4 * ids.size(), no_target);
}

std::string GlbContainer::write() const {
    Json document = document_;
    document["buffers"] = Json::array({{{"byteLength", buffer_.size()}}});
    std::string chunks;
    append_chunk(chunks, 0x4E4F534A, document.dump(-1, ' ', false, Json::error_handler_t::replace),
                 ' ');
    append_chunk(chunks, 0x004E4942, buffer_, '\0');
    std::string bytes = "glTF";
    append(bytes, std::uint32_t{2});
    append(bytes, static_cast<std::uint32_t>(12 + chunks.size()));
    return bytes + chunks;
}

}  // namespace lastflat
