#include "core/numerics/surface_elimination.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace lastflat {
namespace {

/// The surface seen from where it looks largest.
Points2 shadow_of(const Points3& positions) {
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : positions) mean += p;
    mean /= static_cast<double>(positions.size());
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const Vec3& p : positions) covariance += (p - mean) * (p - mean).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
    const Vec3 along = eigen.eigenvectors().col(2), across = eigen.eigenvectors().col(1);
    Points2 shadow;
    shadow.reserve(positions.size());
    for (const Vec3& p : positions) shadow.emplace_back(along.dot(p), across.dot(p));
    return shadow;
}

}  // namespace

Dissection dissection_of(const Points3& positions, const HalfEdges& half_edges) {
    VertexGraph graph;
    graph.begin.push_back(0);
    for (Index v = 0; v < half_edges.vertex_count(); ++v) {
        if (half_edges.outgoing(v) >= 0) {
            auto ring = half_edges.ring(v);
            std::sort(ring.begin(), ring.end());
            graph.neighbours.insert(graph.neighbours.end(), ring.begin(), ring.end());
        }
        graph.begin.push_back(static_cast<Index>(graph.neighbours.size()));
    }
    return nested_dissection(graph, shadow_of(positions));
}

Elimination elimination_of(const Dissection& dissection,
                           const std::function<bool(Index vertex)>& is_unknown) {
    constexpr Index none = -1;
    Elimination elimination;
    std::vector<Index> number(dissection.size(), none);  // of blocks that have unknowns
    std::vector<std::size_t> kept;
    for (std::size_t b = 0; b < dissection.size(); ++b) {
        UnknownBlock block{none, {}};
        for (const Index v : dissection[b].vertices) {
            if (!is_unknown(v)) continue;
            block.unknowns.push_back(static_cast<Index>(elimination.vertices.size()));
            elimination.vertices.push_back(v);
        }
        if (block.unknowns.empty()) continue;
        number[b] = static_cast<Index>(kept.size());
        kept.push_back(b);
        elimination.blocks.push_back(std::move(block));
    }
    for (std::size_t k = 0; k < kept.size(); ++k) {
        Index parent = dissection[kept[k]].parent;
        while (parent >= 0 && number[at(parent)] < 0) parent = dissection[at(parent)].parent;
        elimination.blocks[k].parent = parent < 0 ? none : number[at(parent)];
    }
    return elimination;
}

}  // namespace lastflat
