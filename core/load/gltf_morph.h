// Morph targets of glTF.
#pragma once

#include <compare>
#include <vector>

#include "core/load/tinygltf.h"
#include "core/numerics/types.h"

namespace lastflat::gltf {

/// The weights that a node gives the targets of its mesh: its own, else those of the mesh.
[[nodiscard]] const std::vector<double>& morph_weights(const tinygltf::Node& node,
                                                       const tinygltf::Mesh& mesh);

/// The accessors that move a primitive's positions, with their weights; none of weight 0.
struct MorphTarget {
    int accessor;
    double weight;
    auto operator<=>(const MorphTarget&) const = default;  // NOLINT(modernize-use-nullptr)
};
[[nodiscard]] std::vector<MorphTarget> morph_targets(const tinygltf::Primitive& primitive,
                                                     const std::vector<double>& weights);

/// The positions with the targets added to them, each by its weight.
/// Throws: Error{unreadable_model, model_too_large} naming the accessor.
[[nodiscard]] Points3 morphed(const tinygltf::Model& model, const std::vector<MorphTarget>& targets,
                              Points3 positions);

}  // namespace lastflat::gltf
