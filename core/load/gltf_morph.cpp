// Based on: glTF 2.0, section 3.7.2.2 (morph targets).
#include "core/load/gltf_morph.h"

#include "core/load/gltf_accessor.h"

namespace lastflat::gltf {

const std::vector<double>& morph_weights(const tinygltf::Node& node, const tinygltf::Mesh& mesh) {
    return node.weights.empty() ? mesh.weights : node.weights;
}

std::vector<MorphTarget> morph_targets(const tinygltf::Primitive& primitive,
                                       const std::vector<double>& weights) {
    std::vector<MorphTarget> targets;
    for (std::size_t t = 0; t < primitive.targets.size() && t < weights.size(); ++t) {
        const auto position = primitive.targets[t].find("POSITION");
        if (position != primitive.targets[t].end() && weights[t] != 0.0)
            targets.push_back({position->second, weights[t]});
    }
    return targets;
}

Points3 morphed(const tinygltf::Model& model, const std::vector<MorphTarget>& targets,
                Points3 positions) {
    for (const MorphTarget& target : targets) {
        const auto moves =
            elements_of(model, target.accessor, TINYGLTF_TYPE_VEC3, positions.size());
        if (moves.count != positions.size())
            fail_gltf("accessor " + std::to_string(target.accessor) + ", a morph target, has " +
                      std::to_string(moves.count) + " elements for " +
                      std::to_string(positions.size()) + " vertices");
        for (std::size_t v = 0; v < positions.size(); ++v)
            positions[v] += target.weight * Vec3(moves.at(v, 0), moves.at(v, 1), moves.at(v, 2));
    }
    return positions;
}

}  // namespace lastflat::gltf
