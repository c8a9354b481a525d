#include "core/load/gltf_accessor.h"

#include <cstring>
#include <limits>
#include <type_traits>

namespace lastflat::gltf {
namespace {

template <class T>
double component(const char* at, bool normalized) {
    T value;
    std::memcpy(&value, at, sizeof value);
    if constexpr (std::is_integral_v<T>) {
        if (normalized) {  // glTF 2.0, 3.11: signed values clamp at -1
            return std::max(
                static_cast<double>(value) / static_cast<double>(std::numeric_limits<T>::max()),
                -1.0);
        }
    }
    return static_cast<double>(value);
}

double read_component(const char* at, int type, bool normalized) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: return component<std::int8_t>(at, normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return component<std::uint8_t>(at, normalized);
        case TINYGLTF_COMPONENT_TYPE_SHORT: return component<std::int16_t>(at, normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return component<std::uint16_t>(at, normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return component<std::uint32_t>(at, false);
        case TINYGLTF_COMPONENT_TYPE_FLOAT: return component<float>(at, false);
        default: fail_gltf("component type " + std::to_string(type) + " is not read");
    }
}

std::size_t component_bytes(int type) {
    return static_cast<std::size_t>(
        std::max(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type)), 0));
}

/// A window of `count` elements in a buffer view, from `offset` on.
std::string_view window(const tinygltf::Model& model, int buffer_view, std::size_t offset,
                        std::size_t count, std::size_t size, std::size_t stride,
                        const std::string& name) {
    const std::string_view view = bytes_of(model, buffer_view);
    const bool fits = offset <= view.size() && size <= view.size() - offset && stride >= size &&
                      count - 1 <= (view.size() - offset - size) / stride;
    if (!fits) fail_gltf(name + " reaches past the end of its buffer");
    return view.substr(offset, (count - 1) * stride + size);
}

/// The dense values with those that a sparse accessor replaces.
std::string replaced(const tinygltf::Model& model, const tinygltf::Accessor& accessor,
                     std::string values, std::size_t size, const std::string& name) {
    const auto& sparse = accessor.sparse;
    if (sparse.count <= 0) return values;
    const auto count = static_cast<std::size_t>(sparse.count);
    if (count > accessor.count) fail_gltf(name + " replaces more elements than it has");
    const std::size_t index_size = component_bytes(sparse.indices.componentType);
    if (index_size == 0) fail_gltf(name + " has indices of an unknown type");
    const auto offset = [](auto bytes) { return static_cast<std::size_t>(bytes); };
    const auto indices = window(model, sparse.indices.bufferView, offset(sparse.indices.byteOffset),
                                count, index_size, index_size, name);
    const auto with = window(model, sparse.values.bufferView, offset(sparse.values.byteOffset),
                             count, size, size, name);
    for (std::size_t i = 0; i < count; ++i) {
        const double index =
            read_component(indices.data() + i * index_size, sparse.indices.componentType, false);
        if (!(index >= 0.0) || index >= static_cast<double>(accessor.count))
            fail_gltf(name + " replaces an element that it does not have");
        std::memcpy(values.data() + static_cast<std::size_t>(index) * size, with.data() + i * size,
                    size);
    }
    return values;
}

}  // namespace

void fail_gltf(const std::string& what, ErrorCode code) {
    throw Error(code, "glTF: " + what);
}

std::string_view bytes_of(const tinygltf::Model& model, int buffer_view) {
    const auto& view = item(model.bufferViews, buffer_view, "bufferView");
    const auto& data = item(model.buffers, view.buffer, "buffer").data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
        fail_gltf("bufferView " + std::to_string(buffer_view) +
                  " reaches past the end of its buffer");
    return {reinterpret_cast<const char*>(data.data()) + view.byteOffset, view.byteLength};
}

double Elements::at(std::size_t element, std::size_t i) const {
    const std::string_view bytes = own_.empty() ? bytes_ : std::string_view(own_);
    return read_component(bytes.data() + element * stride_ + i * component_bytes(component_type),
                          component_type, normalized_);
}

Elements elements_of(const tinygltf::Model& model, int index, int type, std::size_t most) {
    const auto& accessor = item(model.accessors, index, "accessor");
    const std::string name = "accessor " + std::to_string(index);
    if (accessor.type != type) fail_gltf(name + " has the wrong type");
    if (accessor.count == 0) fail_gltf(name + " is empty");
    if (accessor.count > most)
        fail_gltf(name + " has " + std::to_string(accessor.count) + " elements; at most " +
                      std::to_string(most) + " are read",
                  ErrorCode::model_too_large);
    const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type));
    const std::size_t size =
        component_bytes(accessor.componentType) * static_cast<std::size_t>(std::max(components, 0));
    if (size == 0) fail_gltf(name + " has an unknown component type");
    Elements elements;
    elements.count = accessor.count;
    elements.component_type = accessor.componentType;
    elements.normalized_ = accessor.normalized;
    elements.stride_ = size;
    const bool sparse = accessor.sparse.isSparse;
    if (accessor.bufferView >= 0 || !sparse) {
        const auto& view = item(model.bufferViews, accessor.bufferView, "bufferView");
        if (view.byteStride != 0) elements.stride_ = view.byteStride;
        elements.bytes_ = window(model, accessor.bufferView, accessor.byteOffset, accessor.count,
                                 size, elements.stride_, name);
    }
    if (!sparse) return elements;
    std::string values(accessor.count * size, '\0');
    for (std::size_t e = 0; !elements.bytes_.empty() && e < accessor.count; ++e)
        std::memcpy(values.data() + e * size, elements.bytes_.data() + e * elements.stride_, size);
    elements.own_ = replaced(model, accessor, std::move(values), size, name);
    elements.stride_ = size;
    return elements;
}

}  // namespace lastflat::gltf
