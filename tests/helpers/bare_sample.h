// The sample last as a workshop would send it: without groups, finer, with what is nailed to it.
#pragma once

#include <map>
#include <set>
#include <vector>

#include "core/sample/sample_last.h"

namespace lastflat::test {

/// Every triangle becomes four in its own plane.
inline RawMesh subdivided(const RawMesh& coarse) {
    RawMesh fine = coarse;
    fine.triangles.clear();
    fine.triangle_labels.clear();
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index a, Index b) {
        const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), -1);
        if (is_new) {
            found->second = static_cast<Index>(fine.positions.size());
            fine.positions.push_back(0.5 * (fine.positions[at(a)] + fine.positions[at(b)]));
        }
        return found->second;
    };
    for (std::size_t t = 0; t < coarse.triangles.size(); ++t) {
        const auto [a, b, c] = coarse.triangles[t];
        const Index x = middle(a, b), y = middle(b, c), z = middle(c, a);
        for (const Triangle& part :
             {Triangle{a, x, z}, Triangle{x, b, y}, Triangle{z, y, c}, Triangle{x, y, z}}) {
            fine.triangles.push_back(part);
            fine.triangle_labels.push_back(coarse.triangle_labels[t]);
        }
    }
    return fine;
}

inline RawMesh bare_sample() {
    RawMesh raw = make_sample_last().mesh;
    raw.label_sets = {{}};
    raw.triangle_labels.assign(raw.triangles.size(), 0);
    return raw;
}

/// The faces that hang together with the one nearest to a point, all corners within a radius of it.
inline std::vector<std::size_t> patch_at(const RawMesh& mesh, const Vec3& point, double radius) {
    std::size_t nearest = 0;
    double least = 1e9;
    const auto middle = [&](std::size_t t) -> Vec3 {
        const auto& [a, b, c] = mesh.triangles[t];
        return (mesh.positions[at(a)] + mesh.positions[at(b)] + mesh.positions[at(c)]) / 3.0;
    };
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if ((middle(t) - point).norm() >= least) continue;
        least = (middle(t) - point).norm();
        nearest = t;
    }
    std::vector<std::size_t> patch{nearest};
    std::set<Index> corners(mesh.triangles[nearest].begin(), mesh.triangles[nearest].end());
    for (bool grows = true; grows;) {
        grows = false;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            if (contains(patch, t)) continue;
            int shared = 0;
            double furthest = 0.0;
            for (const Index v : mesh.triangles[t]) {
                shared += corners.contains(v) ? 1 : 0;
                furthest = std::max(furthest, (mesh.positions[at(v)] - point).norm());
            }
            if (shared < 2 || furthest > radius) continue;
            patch.push_back(t);
            corners.insert(mesh.triangles[t].begin(), mesh.triangles[t].end());
            grows = true;
        }
    }
    return patch;
}

/// Moves a patch of faces, with walls from where its border was: a nail, or a drilled hole.
inline void push(RawMesh& mesh, const std::vector<std::size_t>& patch, const Vec3& by) {
    std::map<Index, Index> moved;
    std::set<std::pair<Index, Index>> sides;
    for (const std::size_t t : patch) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Index a = mesh.triangles[t][i], b = mesh.triangles[t][(i + 1) % 3];
            sides.emplace(a, b);
            if (moved.try_emplace(a, static_cast<Index>(mesh.positions.size())).second)
                mesh.positions.push_back(mesh.positions[at(a)] + by);
        }
    }
    const std::uint32_t label = mesh.triangle_labels[patch.front()];
    for (const std::size_t t : patch) {
        for (Index& v : mesh.triangles[t]) v = moved.at(v);
    }
    for (const auto& [a, b] : sides) {
        if (sides.contains({b, a})) continue;
        mesh.triangles.push_back({a, b, moved.at(b)});
        mesh.triangles.push_back({a, moved.at(b), moved.at(a)});
        mesh.triangle_labels.insert(mesh.triangle_labels.end(), 2, label);
    }
}

}  // namespace lastflat::test
