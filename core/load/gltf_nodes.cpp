#include "core/load/gltf_nodes.h"

#include "core/load/gltf_accessor.h"
#include "core/numerics/types.h"

namespace lastflat::gltf {

Eigen::Affine3d local_transform(const tinygltf::Node& node) {
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

NodeTransforms::NodeTransforms(const tinygltf::Model& model, std::size_t most_levels)
    : model_(model), most_levels_(most_levels), parents_(model.nodes.size(), -1) {
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
        for (const int child : model.nodes[n].children) {
            if (child >= 0 && static_cast<std::size_t>(child) < parents_.size())
                parents_[static_cast<std::size_t>(child)] = static_cast<int>(n);
        }
    }
}

Eigen::Affine3d NodeTransforms::global(int node) const {
    Eigen::Affine3d result = local_transform(item(model_.nodes, node, "node"));
    std::size_t levels = 0;
    for (int up = parents_[static_cast<std::size_t>(node)]; up >= 0;
         up = parents_[static_cast<std::size_t>(up)]) {
        if (++levels > most_levels_)
            fail_gltf("node " + std::to_string(node) + " has too many ancestors",
                      ErrorCode::model_too_large);
        result = local_transform(model_.nodes[static_cast<std::size_t>(up)]) * result;
    }
    return result;
}

}  // namespace lastflat::gltf
