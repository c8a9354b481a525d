// Measures of the sample last's mesh, each from its triangles alone.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/sample/sample_last.h"

namespace lastflat::test {

using Edge = std::pair<Index, Index>;

inline Vec3 at(const RawMesh& mesh, Index vertex) {
    return mesh.positions[static_cast<std::size_t>(vertex)];
}

inline std::string group(const RawMesh& mesh, std::size_t triangle) {
    return mesh.label_sets.at(mesh.triangle_labels.at(triangle)).at(0);
}

inline const std::vector<Index>& curve(const SampleLast& last, const std::string& name) {
    const auto found = std::find_if(last.curves.begin(), last.curves.end(),
                                    [&](const auto& named) { return named.first == name; });
    REQUIRE(found != last.curves.end());
    return found->second;
}

inline double length(const SampleLast& last, const std::string& name) {
    const std::vector<Index>& path = curve(last, name);
    double sum = 0.0;
    for (std::size_t i = 1; i < path.size(); ++i) {
        sum += (at(last.mesh, path[i]) - at(last.mesh, path[i - 1])).norm();
    }
    return sum;
}

/// Every directed edge with the triangle on its left. No directed edge may be used twice.
inline std::map<Edge, std::size_t> triangles_by_edge(const RawMesh& mesh) {
    std::map<Edge, std::size_t> left;
    int used_twice = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle& corners = mesh.triangles[t];
        for (std::size_t k = 0; k < 3; ++k) {
            if (!left.emplace(Edge{corners[k], corners[(k + 1) % 3]}, t).second) ++used_twice;
        }
    }
    REQUIRE(used_twice == 0);
    return left;
}

inline Edge undirected(Index a, Index b) {
    return {std::min(a, b), std::max(a, b)};
}

inline std::set<Edge> path_edges(const std::vector<Index>& path) {
    std::set<Edge> edges;
    for (std::size_t i = 1; i < path.size(); ++i) edges.insert(undirected(path[i - 1], path[i]));
    return edges;
}

inline double volume(const RawMesh& mesh) {
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles) {
        sum += at(mesh, t[0]).dot(at(mesh, t[1]).cross(at(mesh, t[2]))) / 6.0;
    }
    return sum;
}

inline double smallest_angle_deg(const RawMesh& mesh, const Triangle& triangle) {
    double smallest = 180.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 corner = at(mesh, triangle[k]);
        const Vec3 u = at(mesh, triangle[(k + 1) % 3]) - corner;
        const Vec3 v = at(mesh, triangle[(k + 2) % 3]) - corner;
        const double angle = std::atan2(u.cross(v).norm(), u.dot(v));
        smallest = std::min(smallest, angle * 180.0 / std::numbers::pi);
    }
    return smallest;
}

inline double area(const RawMesh& mesh, const Triangle& t) {
    return 0.5 * (at(mesh, t[1]) - at(mesh, t[0])).cross(at(mesh, t[2]) - at(mesh, t[0])).norm();
}

/// The triangles of the upper that can be reached from a vertex without crossing centre_front or
/// heel.
inline std::set<std::size_t> half_around(const SampleLast& last, Index vertex) {
    const auto left = triangles_by_edge(last.mesh);
    std::set<Edge> seams = path_edges(curve(last, "centre_front"));
    seams.merge(path_edges(curve(last, "heel")));
    std::vector<std::size_t> open;
    for (std::size_t t = 0; t < last.mesh.triangles.size(); ++t) {
        const Triangle& corners = last.mesh.triangles[t];
        if (std::find(corners.begin(), corners.end(), vertex) != corners.end()) open.push_back(t);
    }
    std::set<std::size_t> half;
    while (!open.empty()) {
        const std::size_t t = open.back();
        open.pop_back();
        if (group(last.mesh, t) != "upper" || !half.insert(t).second) continue;
        const Triangle& corners = last.mesh.triangles[t];
        for (std::size_t k = 0; k < 3; ++k) {
            const Index a = corners[k], b = corners[(k + 1) % 3];
            if (!seams.contains(undirected(a, b))) open.push_back(left.at({b, a}));
        }
    }
    return half;
}

/// The edges of a set of triangles that lie on one of them only.
inline std::set<Edge> border_edges(const RawMesh& mesh, const std::set<std::size_t>& triangles) {
    std::map<Edge, int> uses;
    for (const std::size_t t : triangles) {
        const Triangle& corners = mesh.triangles[t];
        for (std::size_t k = 0; k < 3; ++k) ++uses[undirected(corners[k], corners[(k + 1) % 3])];
    }
    std::set<Edge> border;
    for (const auto& [edge, count] : uses) {
        if (count == 1) border.insert(edge);
    }
    return border;
}

inline double half_area(const SampleLast& last, Index vertex) {
    double sum = 0.0;
    for (const std::size_t t : half_around(last, vertex)) {
        sum += area(last.mesh, last.mesh.triangles[t]);
    }
    return sum;
}

/// The length of the section of the whole last with the plane of constant x.
inline double girth(const RawMesh& mesh, double x) {
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles) {
        Points3 crossings;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 a = at(mesh, t[k]), b = at(mesh, t[(k + 1) % 3]);
            if ((a.x() < x) != (b.x() < x)) {
                crossings.push_back(a + (x - a.x()) / (b.x() - a.x()) * (b - a));
            }
        }
        if (crossings.size() == 2) sum += (crossings[1] - crossings[0]).norm();
    }
    return sum;
}

/// Does the open edge a-b pass through the inside of a triangle? By signs of volumes; touching or
/// lying in the plane counts as no.
inline bool pierces(const Vec3& a, const Vec3& b, const std::array<Vec3, 3>& t) {
    const auto side = [](const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
        return (q - p).cross(r - p).dot(s - p);
    };
    if (side(t[0], t[1], t[2], a) * side(t[0], t[1], t[2], b) >= 0.0) return false;
    const double u = side(a, b, t[0], t[1]), v = side(a, b, t[1], t[2]), w = side(a, b, t[2], t[0]);
    return (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
}

/// How many times an edge of the mesh passes through a triangle it shares no vertex with. Triangles
/// are sorted into cubes of 10 mm; only those that share a cube are compared.
inline int self_intersections(const RawMesh& mesh) {
    constexpr double cube = 10.0;
    std::map<std::array<int, 3>, std::vector<std::size_t>> cubes;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle& c = mesh.triangles[t];
        const Vec3 low = at(mesh, c[0]).cwiseMin(at(mesh, c[1])).cwiseMin(at(mesh, c[2])) / cube;
        const Vec3 high = at(mesh, c[0]).cwiseMax(at(mesh, c[1])).cwiseMax(at(mesh, c[2])) / cube;
        const auto cell = [](double value) { return static_cast<int>(std::floor(value)); };
        for (int i = cell(low.x()); i <= cell(high.x()); ++i) {
            for (int j = cell(low.y()); j <= cell(high.y()); ++j) {
                for (int k = cell(low.z()); k <= cell(high.z()); ++k) cubes[{i, j, k}].push_back(t);
            }
        }
    }
    int count = 0;
    for (const auto& [place, inside] : cubes) {
        for (const std::size_t s : inside) {
            const Triangle& e = mesh.triangles[s];
            for (const std::size_t t : inside) {
                const Triangle& f = mesh.triangles[t];
                const std::array<Vec3, 3> corners = {at(mesh, f[0]), at(mesh, f[1]),
                                                     at(mesh, f[2])};
                for (std::size_t k = 0; k < 3; ++k) {
                    const Index a = e[k], b = e[(k + 1) % 3];
                    const auto is_corner = [&f](Index v) { return std::ranges::count(f, v) > 0; };
                    if (is_corner(a) || is_corner(b)) continue;
                    if (pierces(at(mesh, a), at(mesh, b), corners)) ++count;
                }
            }
        }
    }
    return count;
}

}  // namespace lastflat::test
