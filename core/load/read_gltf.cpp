// The only file that sees tinygltf. It checks structure, not contents: every accessor is checked
// here before it is read.
#include "core/load/read_gltf.h"

#include <Eigen/Geometry>
#include <cstring>
#include <map>

#include "core/load/gltf_guard.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <tiny_gltf.h>
#pragma GCC diagnostic pop

namespace lastflat {
namespace {

[[noreturn]] void fail(const std::string& what, ErrorCode code = ErrorCode::unreadable_model) {
    throw Error(code, "glTF: " + what);
}

template <class List>
const auto& item(const List& list, int index, const char* what) {
    if (index < 0 || static_cast<std::size_t>(index) >= list.size()) {
        fail(std::string(what) + " " + std::to_string(index) + " does not exist");
    }
    return list[static_cast<std::size_t>(index)];
}

/// A checked window on the bytes of an accessor: element i begins at `bytes + i * stride`.
struct Elements {
    const unsigned char* bytes;
    std::size_t stride, count;
    int component_type;
    bool normalized;
};

Elements checked_elements(const tinygltf::Model& model, int index, int type) {
    const auto& accessor = item(model.accessors, index, "accessor");
    const std::string name = "accessor " + std::to_string(index);
    if (accessor.type != type) fail(name + " has the wrong type");
    if (accessor.sparse.isSparse) {
        fail(name + " is sparse, which this version does not read for positions and indices",
             ErrorCode::unsupported_model);
    }
    const auto& view = item(model.bufferViews, accessor.bufferView, "bufferView");
    const auto& buffer = item(model.buffers, view.buffer, "buffer");
    const int component =
        tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
    const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type));
    if (component <= 0 || components <= 0) fail(name + " has an unknown component type");
    const auto size = static_cast<std::size_t>(component) * static_cast<std::size_t>(components);
    const std::size_t stride = view.byteStride != 0 ? view.byteStride : size;
    if (accessor.count == 0) fail(name + " is empty");
    const std::size_t data = buffer.data.size();
    const bool fits =
        view.byteOffset <= data && view.byteLength <= data - view.byteOffset &&
        accessor.byteOffset <= view.byteLength && size <= view.byteLength - accessor.byteOffset &&
        stride >= size &&
        (accessor.count - 1) <= (view.byteLength - accessor.byteOffset - size) / stride;
    if (!fits) fail(name + " reaches past the end of its buffer");
    return {buffer.data.data() + view.byteOffset + accessor.byteOffset, stride, accessor.count,
            accessor.componentType, accessor.normalized};
}

template <class T>
double component(const unsigned char* at, bool normalized) {
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

double read_component(const Elements& elements, std::size_t element, std::size_t i) {
    const unsigned char* at = elements.bytes + element * elements.stride;
    switch (elements.component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return component<std::int8_t>(at + i, elements.normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return component<std::uint8_t>(at + i, elements.normalized);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return component<std::int16_t>(at + 2 * i, elements.normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return component<std::uint16_t>(at + 2 * i, elements.normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return component<std::uint32_t>(at + 4 * i, false);
        case TINYGLTF_COMPONENT_TYPE_FLOAT: return component<float>(at + 4 * i, false);
        default: fail("component type " + std::to_string(elements.component_type) + " is not read");
    }
}

class SceneReader {
public:
    SceneReader(const tinygltf::Model& model, const LoadLimits& limits)
        : model_(model), limits_(limits), on_path_(model.nodes.size(), false) {}

    RawMesh read() {
        mesh_.default_unit_mm = 1000.0;
        for (const int root : roots()) read_node(root, Eigen::Affine3d::Identity(), {}, 0);
        if (mesh_.triangles.empty()) fail("the scene has no triangles");
        mesh_.indexed = any_indices_;
        return std::move(mesh_);
    }

private:
    std::vector<int> roots() const {
        if (!model_.scenes.empty()) {
            return item(model_.scenes, std::max(model_.defaultScene, 0), "scene").nodes;
        }
        std::vector<int> result;
        std::vector<bool> is_child(model_.nodes.size(), false);
        for (const auto& node : model_.nodes) {
            for (const int child : node.children) {
                item(model_.nodes, child, "node");
                is_child[static_cast<std::size_t>(child)] = true;
            }
        }
        for (std::size_t i = 0; i < is_child.size(); ++i) {
            if (!is_child[i]) result.push_back(static_cast<int>(i));
        }
        return result;
    }

    static Eigen::Affine3d transform_of(const tinygltf::Node& node) {
        Eigen::Affine3d result = Eigen::Affine3d::Identity();
        if (node.matrix.size() == 16) {
            result.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
            return result;
        }
        if (node.translation.size() == 3) {
            result.translate(Vec3(node.translation[0], node.translation[1], node.translation[2]));
        }
        if (node.rotation.size() == 4) {
            const Eigen::Quaterniond q(node.rotation[3], node.rotation[0], node.rotation[1],
                                       node.rotation[2]);
            if (q.norm() > 0.0) result.rotate(q.normalized());
        }
        if (node.scale.size() == 3) {
            result.scale(Vec3(node.scale[0], node.scale[1], node.scale[2]));
        }
        return result;
    }

    void read_node(int index, const Eigen::Affine3d& parent, std::vector<std::string> names,
                   std::size_t depth) {
        const auto& node = item(model_.nodes, index, "node");
        if (on_path_[static_cast<std::size_t>(index)]) {
            fail("node " + std::to_string(index) + " is its own descendant");
        }
        if (depth > limits_.json_depth || ++visits_ > max_visits) {
            fail("the scene has too many levels or nodes", ErrorCode::model_too_large);
        }
        on_path_[static_cast<std::size_t>(index)] = true;
        add_name(names, node.name);
        const Eigen::Affine3d transform = parent * transform_of(node);
        if (node.mesh >= 0) {
            const auto& mesh = item(model_.meshes, node.mesh, "mesh");
            bases_.clear();
            for (const auto& primitive : mesh.primitives) {
                auto labels = names;
                add_name(labels, mesh.name);
                if (primitive.material >= 0) {
                    add_name(labels, item(model_.materials, primitive.material, "material").name);
                }
                read_primitive(primitive, transform, labels);
            }
        }
        for (const int child : node.children) read_node(child, transform, names, depth + 1);
        on_path_[static_cast<std::size_t>(index)] = false;
    }

    void add_name(std::vector<std::string>& names, const std::string& name) const {
        if (name.size() > limits_.name_bytes) {
            fail("a name is longer than " + std::to_string(limits_.name_bytes) + " bytes",
                 ErrorCode::model_too_large);
        }
        if (name.empty()) return;
        if (names.size() >= limits_.face_names) {
            fail("a face has more than " + std::to_string(limits_.face_names) + " names",
                 ErrorCode::model_too_large);
        }
        names.push_back(name);
    }

    void read_primitive(const tinygltf::Primitive& primitive, const Eigen::Affine3d& transform,
                        const std::vector<std::string>& labels) {
        const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
        spend(1);
        if (mode > TINYGLTF_MODE_TRIANGLE_FAN) {
            fail("the primitive mode " + std::to_string(mode) + " does not exist");
        }
        if (mode < TINYGLTF_MODE_TRIANGLES) return;  // points and lines have no surface
        const auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end()) fail("a primitive has no POSITION");
        const auto [base, count] = read_positions(position->second, transform);
        const auto corners = read_corners(primitive.indices, base, count);
        spend(corners.size());
        const std::uint32_t label = label_of(labels);
        const bool mirrored = transform.linear().determinant() < 0.0;
        const std::size_t step = mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
        for (std::size_t i = 0; i + 3 <= corners.size(); i += step) {
            Triangle triangle{corners[i], corners[i + 1], corners[i + 2]};
            if (mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 == 1)
                std::swap(triangle[0], triangle[1]);
            if (mode == TINYGLTF_MODE_TRIANGLE_FAN) triangle[0] = corners[0];
            if (mirrored) std::swap(triangle[1], triangle[2]);
            if (mode != TINYGLTF_MODE_TRIANGLES &&  // strips repeat vertices to turn corners
                (triangle[0] == triangle[1] || triangle[1] == triangle[2] ||
                 triangle[2] == triangle[0])) {
                continue;
            }
            mesh_.triangles.push_back(triangle);
            mesh_.triangle_labels.push_back(label);
        }
        if (mesh_.triangles.size() > limits_.triangles) {
            fail("more than " + std::to_string(limits_.triangles) + " triangles",
                 ErrorCode::model_too_large);
        }
    }

    /// Returns the id of the first vertex and their number.
    std::pair<Index, std::size_t> read_positions(int accessor, const Eigen::Affine3d& transform) {
        const auto elements = checked_elements(model_, accessor, TINYGLTF_TYPE_VEC3);
        if (const auto known = bases_.find(accessor); known != bases_.end()) {
            return {known->second, elements.count};
        }
        if (elements.count > limits_.vertices - mesh_.positions.size()) {
            fail("more than " + std::to_string(limits_.vertices) + " vertices",
                 ErrorCode::model_too_large);
        }
        const auto base = static_cast<Index>(mesh_.positions.size());
        for (std::size_t i = 0; i < elements.count; ++i) {
            const Vec3 local(read_component(elements, i, 0), read_component(elements, i, 1),
                             read_component(elements, i, 2));
            const Vec3 position = transform * local;
            if (!position.allFinite()) {
                fail("vertex " + std::to_string(i) + " of accessor " + std::to_string(accessor) +
                         " is not finite",
                     ErrorCode::mesh_degenerate);
            }
            mesh_.positions.push_back(position);
        }
        bases_[accessor] = base;
        return {base, elements.count};
    }

    std::vector<Index> read_corners(int accessor, Index base, std::size_t count) {
        std::vector<Index> corners;
        if (accessor < 0) {
            for (std::size_t i = 0; i < count; ++i) corners.push_back(base + static_cast<Index>(i));
            return corners;
        }
        any_indices_ = true;
        const auto elements = checked_elements(model_, accessor, TINYGLTF_TYPE_SCALAR);
        if (elements.component_type == TINYGLTF_COMPONENT_TYPE_FLOAT ||
            elements.component_type == TINYGLTF_COMPONENT_TYPE_BYTE ||
            elements.component_type == TINYGLTF_COMPONENT_TYPE_SHORT) {
            fail("accessor " + std::to_string(accessor) +
                 " holds indices of a type that has a sign");
        }
        if (elements.count / 3 > limits_.triangles) {
            fail("more than " + std::to_string(limits_.triangles) + " triangles",
                 ErrorCode::model_too_large);
        }
        for (std::size_t i = 0; i < elements.count; ++i) {
            const double index = read_component(elements, i, 0);
            if (index >= static_cast<double>(count)) {
                fail("index " + std::to_string(static_cast<std::uint64_t>(index)) +
                     " of accessor " + std::to_string(accessor) + " is past its " +
                     std::to_string(count) + " vertices");
            }
            corners.push_back(base + static_cast<Index>(index));
        }
        return corners;
    }

    /// Counts work that leaves no trace in the mesh: primitives without triangles, strips of
    /// repeated vertices, shared accessors read again and again.
    void spend(std::size_t work) {
        work_ += work;
        if (work_ > 4 * limits_.triangles) {
            fail("the scene repeats its primitives too often", ErrorCode::model_too_large);
        }
    }

    std::uint32_t label_of(const std::vector<std::string>& names) {
        const auto next = static_cast<std::uint32_t>(mesh_.label_sets.size());
        const auto [found, is_new] = known_labels_.try_emplace(names, next);
        if (is_new) {
            if (next >= limits_.name_sets) {
                fail("more than " + std::to_string(limits_.name_sets) + " sets of names",
                     ErrorCode::model_too_large);
            }
            mesh_.label_sets.push_back(names);
        }
        return found->second;
    }

    static constexpr std::size_t max_visits = 100'000;
    const tinygltf::Model& model_;
    LoadLimits limits_;
    RawMesh mesh_;
    std::vector<bool> on_path_;   ///< per node, whether it is being read
    std::map<int, Index> bases_;  ///< of the node at hand: accessor to first vertex id
    std::map<std::vector<std::string>, std::uint32_t> known_labels_;
    std::size_t visits_ = 0, work_ = 0;
    bool any_indices_ = false;
};

bool no_file_exists(const std::string&, void*) {
    return false;
}
std::string no_expansion(const std::string&, void*) {
    return {};
}
bool read_no_file(std::vector<unsigned char>*, std::string*, const std::string&, void*) {
    return false;
}
bool write_no_file(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
}
bool skip_image(tinygltf::Image*, const int, std::string*, std::string*, int, int,
                const unsigned char*, int, void*) {
    return true;
}

RawMesh read_with_tinygltf(std::string_view bytes, bool binary, const LoadLimits& limits) {
    if (bytes.size() > std::numeric_limits<unsigned>::max()) {
        fail("larger than 4 GiB", ErrorCode::model_too_large);
    }
    tinygltf::TinyGLTF reader;
    reader.SetFsCallbacks({no_file_exists, no_expansion, read_no_file, write_no_file, nullptr});
    reader.SetImageLoader(skip_image, nullptr);
    tinygltf::Model model;
    std::string error, warning;
    const auto size = static_cast<unsigned>(bytes.size());
    const bool read =
        binary ? reader.LoadBinaryFromMemory(&model, &error, &warning,
                                             reinterpret_cast<const unsigned char*>(bytes.data()),
                                             size)
               : reader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, "");
    if (!read) {
        while (!error.empty() && (error.back() == '\n' || error.back() == ' ')) error.pop_back();
        fail(error.empty() ? "the document is not valid" : error.substr(0, 200));
    }
    return SceneReader(model, limits).read();
}

}  // namespace

RawMesh read_gltf(std::string_view text, const LoadLimits& limits) {
    guard_gltf(text, limits);
    return read_with_tinygltf(text, false, limits);
}

RawMesh read_glb(std::string_view bytes, const LoadLimits& limits) {
    guard_gltf(json_chunk(bytes), limits);
    return read_with_tinygltf(bytes, true, limits);
}

}  // namespace lastflat
