// Where the nodes of a glTF scene stand.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/load/tinygltf.h"

namespace lastflat::gltf {

/// A node's own matrix, or its translation, rotation and scale.
[[nodiscard]] Eigen::Affine3d local_transform(const tinygltf::Node& node);

class NodeTransforms {
public:
    NodeTransforms(const tinygltf::Model& model, std::size_t most_levels);

    /// From the node's space to the scene's, at rest: no animation moves it.
    /// Throws: Error{unreadable_model, model_too_large} if the node does not exist, or stands too
    ///         deep.
    [[nodiscard]] Eigen::Affine3d global(int node) const;

private:
    const tinygltf::Model& model_;
    std::size_t most_levels_;
    std::vector<int> parents_;  ///< -1: a root
};

}  // namespace lastflat::gltf
