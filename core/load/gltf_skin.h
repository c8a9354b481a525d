// Skins of glTF: vertices that follow joints.
#pragma once

#include <vector>

#include "core/load/gltf_nodes.h"
#include "core/numerics/types.h"

namespace lastflat::gltf {

/// For every joint of a skin, where it takes the vertices that it was bound to, its node at rest.
/// Throws: Error{unreadable_model, model_too_large} naming the accessor or the node.
[[nodiscard]] std::vector<Eigen::Affine3d> joint_matrices(const tinygltf::Model& model, int skin,
                                                          const NodeTransforms& nodes);

/// The accessors of a primitive's joints and weights: JOINTS_0, WEIGHTS_0, JOINTS_1 and so on.
/// Throws: Error{unreadable_model} if there is one without the other.
[[nodiscard]] std::vector<int> skin_accessors(const tinygltf::Primitive& primitive);

struct Skinned {
    Points3 positions;  ///< in the scene: the transform of the mesh's own node has no part in it
    bool mirrored = false;  ///< the first vertex is, and with it all of them in any sane skin
};

/// Throws: Error{unreadable_model, model_too_large} naming the accessor.
[[nodiscard]] Skinned skinned(const tinygltf::Model& model, const std::vector<int>& accessors,
                              const std::vector<Eigen::Affine3d>& joints, Points3 positions);

}  // namespace lastflat::gltf
