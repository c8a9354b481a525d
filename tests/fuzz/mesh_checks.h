// What every reader promises of the mesh that it returns; a broken promise ends the program.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/load/load_model.h"

namespace lastflat::fuzz {

inline void require(bool promise) {
    if (!promise) std::abort();
}

inline std::string_view text(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// Small, so that the limits themselves are reached by small inputs.
inline LoadLimits small_limits() {
    LoadLimits limits;
    limits.vertices = 20'000;
    limits.triangles = 20'000;
    limits.polygon_corners = 256;
    limits.name_sets = 64;
    return limits;
}

inline void check(const RawMesh& mesh) {
    const LoadLimits limits = small_limits();
    require(!mesh.triangles.empty() && mesh.triangles.size() <= limits.triangles);
    require(mesh.positions.size() <= (mesh.indexed ? limits.vertices : 3 * limits.triangles));
    require(mesh.triangle_labels.size() == mesh.triangles.size());
    for (const Vec3& position : mesh.positions) require(position.allFinite());
    for (const std::uint32_t label : mesh.triangle_labels) require(label < mesh.label_sets.size());
    for (const Triangle& triangle : mesh.triangles) {
        for (const Index vertex : triangle) {
            require(vertex >= 0 && static_cast<std::size_t>(vertex) < mesh.positions.size());
        }
    }
}

}  // namespace lastflat::fuzz
