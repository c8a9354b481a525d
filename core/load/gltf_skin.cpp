// Based on: glTF 2.0, section 3.7.3 (skins). Weights are divided by their sum, as viewers do.
#include "core/load/gltf_skin.h"

#include "core/load/gltf_accessor.h"

namespace lastflat::gltf {
namespace {

constexpr std::size_t most_matrices = 65'536;

Elements influences(const tinygltf::Model& model, int accessor, std::size_t vertices) {
    auto elements = elements_of(model, accessor, TINYGLTF_TYPE_VEC4, vertices);
    if (elements.count != vertices)
        fail_gltf("accessor " + std::to_string(accessor) + ", of a skin, has " +
                  std::to_string(elements.count) + " elements for " + std::to_string(vertices) +
                  " vertices");
    return elements;
}

}  // namespace

std::vector<Eigen::Affine3d> joint_matrices(const tinygltf::Model& model, int index,
                                            const NodeTransforms& nodes) {
    const auto& skin = item(model.skins, index, "skin");
    std::vector<Eigen::Affine3d> joints;
    for (const int joint : skin.joints) joints.push_back(nodes.global(joint));
    if (skin.inverseBindMatrices < 0) return joints;
    const auto inverse_binds =
        elements_of(model, skin.inverseBindMatrices, TINYGLTF_TYPE_MAT4, most_matrices);
    if (inverse_binds.count < joints.size())
        fail_gltf("skin " + std::to_string(index) + " has more joints than inverse bind matrices");
    for (std::size_t j = 0; j < joints.size(); ++j) {
        Eigen::Affine3d inverse_bind;
        for (std::size_t i = 0; i < 16; ++i)
            inverse_bind.matrix().data()[i] = inverse_binds.at(j, i);
        joints[j] = joints[j] * inverse_bind;
    }
    return joints;
}

std::vector<int> skin_accessors(const tinygltf::Primitive& primitive) {
    std::vector<int> accessors;
    for (std::size_t set = 0;; ++set) {
        const auto joints = primitive.attributes.find("JOINTS_" + std::to_string(set));
        const auto weights = primitive.attributes.find("WEIGHTS_" + std::to_string(set));
        const bool last = joints == primitive.attributes.end();
        if (last != (weights == primitive.attributes.end()))
            fail_gltf("a primitive of a skin has JOINTS or WEIGHTS without the other");
        if (last) break;
        accessors.push_back(joints->second);
        accessors.push_back(weights->second);
    }
    return accessors;
}

Skinned skinned(const tinygltf::Model& model, const std::vector<int>& accessors,
                const std::vector<Eigen::Affine3d>& joints, Points3 positions) {
    std::vector<Elements> sets;
    sets.reserve(accessors.size());
    for (const int accessor : accessors)
        sets.push_back(influences(model, accessor, positions.size()));
    Skinned result;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        Eigen::Matrix4d blend = Eigen::Matrix4d::Zero();
        double sum = 0.0;
        for (std::size_t i = 0; i < 2 * sets.size(); ++i) {
            const std::size_t set = i / 4 * 2, component = i % 4;
            const double weight = sets[set + 1].at(v, component);
            if (weight == 0.0) continue;
            const double joint = sets[set].at(v, component);
            if (!(joint >= 0.0 && joint < static_cast<double>(joints.size())))
                fail_gltf("accessor " + std::to_string(accessors[set]) +
                          " names a joint that the skin does not have");
            blend += weight * joints[static_cast<std::size_t>(joint)].matrix();
            sum += weight;
        }
        if (!(sum > 0.0)) fail_gltf("vertex " + std::to_string(v) + " of a skin has no weight");
        blend /= sum;
        if (v == 0) result.mirrored = blend.topLeftCorner<3, 3>().determinant() < 0.0;
        positions[v] = Eigen::Affine3d(blend) * positions[v];
    }
    result.positions = std::move(positions);
    return result;
}

}  // namespace lastflat::gltf
