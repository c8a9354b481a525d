#include "core/load/read_gltf.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <compare>
#include <map>

#include "core/load/gltf_accessor.h"
#include "core/load/gltf_guard.h"
#include "core/load/gltf_morph.h"
#include "core/load/gltf_nodes.h"
#include "core/load/gltf_skin.h"
#include "core/load/gltf_unpack.h"

namespace lastflat {

using namespace gltf;

namespace {

class SceneReader {
public:
    SceneReader(const tinygltf::Model& model, const LoadLimits& limits)
        : model_(model),
          limits_(limits),
          nodes_(model, limits.json_depth),
          on_path_(model.nodes.size(), false) {}

    RawMesh read() {
        mesh_.default_unit_mm = 1000.0;
        for (const int root : roots()) read_node(root, Eigen::Affine3d::Identity(), {}, 0);
        if (mesh_.triangles.empty()) fail_gltf("the scene has no triangles");
        mesh_.indexed = any_indices_;
        if (any_indices_ && mesh_.positions.size() > limits_.vertices) {
            fail_gltf("more than " + std::to_string(limits_.vertices) + " vertices",
                      ErrorCode::model_too_large);
        }
        return std::move(mesh_);
    }

private:
    /// What moves the vertices of a node's mesh.
    struct Pose {
        std::string node;
        Eigen::Affine3d transform;
        const std::vector<double>* weights;          ///< of its morph targets
        const std::vector<Eigen::Affine3d>* joints;  ///< if it has a skin: then no transform
    };

    /// The accessors that vertices come from.
    struct VertexData {
        int positions;
        std::vector<MorphTarget> targets;
        std::vector<int> skin;
        auto operator<=>(const VertexData&) const = default;  // NOLINT(modernize-use-nullptr)
    };

    struct Vertices {
        Index base;  ///< the id of the first
        std::size_t count;
        bool mirrored;
    };

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

    void read_node(int index, const Eigen::Affine3d& parent, std::vector<std::string> names,
                   std::size_t depth) {
        const auto& node = item(model_.nodes, index, "node");
        if (on_path_[static_cast<std::size_t>(index)]) {
            fail_gltf("node " + std::to_string(index) + " is its own descendant");
        }
        if (depth > limits_.json_depth) {
            fail_gltf("the scene has too many levels", ErrorCode::model_too_large);
        }
        visit(1);
        on_path_[static_cast<std::size_t>(index)] = true;
        add_name(names, node.name);
        const Eigen::Affine3d transform = parent * local_transform(node);
        if (node.mesh >= 0) {
            const auto& mesh = item(model_.meshes, node.mesh, "mesh");
            vertices_.clear();
            const Pose pose{"node " + std::to_string(index), transform, &morph_weights(node, mesh),
                            node.skin < 0 ? nullptr : &joints_of(node.skin)};
            for (const auto& primitive : mesh.primitives) {
                auto labels = names;
                add_name(labels, mesh.name);
                if (primitive.material >= 0) {
                    add_name(labels, item(model_.materials, primitive.material, "material").name);
                }
                read_primitive(primitive, pose, labels);
            }
        }
        for (const int child : node.children) read_node(child, transform, names, depth + 1);
        on_path_[static_cast<std::size_t>(index)] = false;
    }

    void add_name(std::vector<std::string>& names, const std::string& name) const {
        if (name.size() > limits_.name_bytes) {
            fail_gltf("a name is longer than " + std::to_string(limits_.name_bytes) + " bytes",
                      ErrorCode::model_too_large);
        }
        if (name.empty()) return;
        if (names.size() >= limits_.face_names) {
            fail_gltf("a face has more than " + std::to_string(limits_.face_names) + " names",
                      ErrorCode::model_too_large);
        }
        names.push_back(name);
    }

    void read_primitive(const tinygltf::Primitive& primitive, const Pose& pose,
                        const std::vector<std::string>& labels) {
        const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
        spend(1);
        if (mode > TINYGLTF_MODE_TRIANGLE_FAN) {
            fail_gltf("the primitive mode " + std::to_string(mode) + " does not exist");
        }
        if (mode == TINYGLTF_MODE_POINTS) return;
        const auto [base, count, mirrored] = read_vertices(primitive, pose);
        auto corners = read_corners(primitive.indices, base, count);
        spend(corners.size());
        if (mode < TINYGLTF_MODE_TRIANGLES) return read_line(mode, std::move(corners), labels);
        const std::uint32_t label = label_of(labels);
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
            fail_gltf("more than " + std::to_string(limits_.triangles) + " triangles",
                      ErrorCode::model_too_large);
        }
    }

    Index add_positions(const Points3& positions, const Eigen::Affine3d& transform, int accessor) {
        if (positions.size() > most_positions() - mesh_.positions.size()) {
            fail_gltf("more than " + std::to_string(limits_.vertices) + " vertices",
                      ErrorCode::model_too_large);
        }
        const auto base = static_cast<Index>(mesh_.positions.size());
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const Vec3 position = transform * positions[i];
            if (!position.allFinite()) {
                fail_gltf("vertex " + std::to_string(i) + " of accessor " +
                              std::to_string(accessor) + " is not finite",
                          ErrorCode::mesh_degenerate);
            }
            mesh_.positions.push_back(position);
        }
        return base;
    }

    void read_line(int mode, std::vector<Index> corners, const std::vector<std::string>& names) {
        if (mesh_.lines.size() >= limits_.lines)
            fail_gltf("more than " + std::to_string(limits_.lines) + " lines",
                      ErrorCode::model_too_large);
        if (mode == TINYGLTF_MODE_LINE_LOOP && !corners.empty()) corners.push_back(corners.front());
        RawMesh::Line line{names, {}};
        // Segments of a list make one line where each begins where the last ended.
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const bool joins = mode == TINYGLTF_MODE_LINE && i % 2 == 0 && !line.vertices.empty();
            if (joins && line.vertices.back() != corners[i]) break;
            if (!joins) line.vertices.push_back(corners[i]);
        }
        if (line.vertices.size() > 1) mesh_.lines.push_back(std::move(line));
    }

    Vertices read_vertices(const tinygltf::Primitive& primitive, const Pose& pose) {
        const auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end()) fail_gltf("a primitive has no POSITION");
        VertexData data{position->second, morph_targets(primitive, *pose.weights), {}};
        if (pose.joints != nullptr) data.skin = skin_accessors(primitive);
        if (pose.joints != nullptr && data.skin.empty()) {
            fail_gltf(pose.node + " has a skin, and its mesh no JOINTS_0; export without the skin",
                      ErrorCode::unsupported_model);
        }
        if (const auto known = vertices_.find(data); known != vertices_.end()) return known->second;
        const auto elements =
            elements_of(model_, data.positions, TINYGLTF_TYPE_VEC3,
                        primitive.indices < 0 ? most_positions() : limits_.vertices);
        spend(elements.count * (data.targets.size() + data.skin.size()));
        Points3 positions;
        positions.reserve(elements.count);
        for (std::size_t i = 0; i < elements.count; ++i)
            positions.emplace_back(elements.at(i, 0), elements.at(i, 1), elements.at(i, 2));
        positions = morphed(model_, data.targets, std::move(positions));
        Eigen::Affine3d transform = pose.transform;
        bool mirrored = transform.linear().determinant() < 0.0;
        if (pose.joints != nullptr) {
            Skinned posed = skinned(model_, data.skin, *pose.joints, std::move(positions));
            positions = std::move(posed.positions);
            mirrored = posed.mirrored;
            transform.setIdentity();
        }
        const Index base = add_positions(positions, transform, data.positions);
        return vertices_[data] = {base, positions.size(), mirrored};
    }

    const std::vector<Eigen::Affine3d>& joints_of(int skin) {
        if (const auto known = joints_.find(skin); known != joints_.end()) return known->second;
        visit(item(model_.skins, skin, "skin").joints.size());
        return joints_[skin] = joint_matrices(model_, skin, nodes_);
    }

    std::vector<Index> read_corners(int accessor, Index base, std::size_t count) {
        std::vector<Index> corners;
        if (accessor < 0) {
            for (std::size_t i = 0; i < count; ++i) corners.push_back(base + static_cast<Index>(i));
            return corners;
        }
        any_indices_ = true;
        const auto elements =
            elements_of(model_, accessor, TINYGLTF_TYPE_SCALAR, 3 * limits_.triangles + 2);
        if (elements.component_type == TINYGLTF_COMPONENT_TYPE_FLOAT ||
            elements.component_type == TINYGLTF_COMPONENT_TYPE_BYTE ||
            elements.component_type == TINYGLTF_COMPONENT_TYPE_SHORT) {
            fail_gltf("accessor " + std::to_string(accessor) +
                      " holds indices of a type that has a sign");
        }
        for (std::size_t i = 0; i < elements.count; ++i) {
            const double index = elements.at(i, 0);
            if (index >= static_cast<double>(count)) {
                fail_gltf("index " + std::to_string(static_cast<std::uint64_t>(index)) +
                          " of accessor " + std::to_string(accessor) + " is past its " +
                          std::to_string(count) + " vertices");
            }
            corners.push_back(base + static_cast<Index>(index));
        }
        return corners;
    }

    /// Three corners a triangle may be vertices of their own where there are no indices: they are
    /// counted when they are welded.
    [[nodiscard]] std::size_t most_positions() const {
        return std::max(limits_.vertices, 3 * limits_.triangles);
    }

    void visit(std::size_t nodes) {
        visits_ += nodes;
        if (visits_ > max_visits) {
            fail_gltf("the scene has too many nodes", ErrorCode::model_too_large);
        }
    }

    /// Counts work that leaves no trace in the mesh: primitives without triangles, strips of
    /// repeated vertices, shared accessors read again and again.
    void spend(std::size_t work) {
        work_ += work;
        if (work_ > 4 * limits_.triangles) {
            fail_gltf("the scene repeats its primitives, or moves its vertices, too often",
                      ErrorCode::model_too_large);
        }
    }

    std::uint32_t label_of(const std::vector<std::string>& names) {
        const auto next = static_cast<std::uint32_t>(mesh_.label_sets.size());
        const auto [found, is_new] = known_labels_.try_emplace(names, next);
        if (is_new) {
            if (next >= limits_.name_sets) {
                fail_gltf("more than " + std::to_string(limits_.name_sets) + " sets of names",
                          ErrorCode::model_too_large);
            }
            mesh_.label_sets.push_back(names);
        }
        return found->second;
    }

    static constexpr std::size_t max_visits = 100'000;
    const tinygltf::Model& model_;
    LoadLimits limits_;
    NodeTransforms nodes_;
    RawMesh mesh_;
    std::vector<bool> on_path_;                           ///< per node, whether it is being read
    std::map<VertexData, Vertices> vertices_;             ///< of the node at hand
    std::map<int, std::vector<Eigen::Affine3d>> joints_;  ///< per skin
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
        fail_gltf("larger than 4 GiB", ErrorCode::model_too_large);
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
        fail_gltf(error.empty() ? "the document is not valid" : error.substr(0, 200));
    }
    return SceneReader(model, limits).read();
}

}  // namespace

RawMesh read_gltf(std::string_view text, const LoadLimits& limits) {
    const std::optional<std::string> rewritten = guard_gltf(text, limits);
    const std::string_view json = rewritten ? std::string_view(*rewritten) : text;
    if (is_packed_gltf(json)) return read_with_tinygltf(unpack_gltf(json, limits), true, limits);
    return read_with_tinygltf(json, false, limits);
}

RawMesh read_glb(std::string_view bytes, const LoadLimits& limits) {
    std::string rewritten;
    if (const auto json = guard_gltf(json_chunk(bytes), limits)) {
        rewritten = with_json_chunk(bytes, *json);
        bytes = rewritten;
    }
    if (is_packed_gltf(json_chunk(bytes)))
        return read_with_tinygltf(unpack_glb(bytes, limits), true, limits);
    return read_with_tinygltf(bytes, true, limits);
}

}  // namespace lastflat
