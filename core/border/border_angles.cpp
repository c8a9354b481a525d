// Based on: Sawhney, Crane, "Boundary First Flattening", TOG 2017, and Kim, Kim, "Geodesic-Fan
// Based Mesh Parameterization in Shoe CAD System".
#include "core/border/border_angles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/numerics/geometry.h"
#include "core/numerics/multifrontal_ldlt.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

using std::numbers::pi;

double corner_angle(const Region& region, Index apex, Index a, Index b) {
    return angle_at(region.position(apex), region.position(a), region.position(b));
}

/// Half the cotangents of every triangle's angles (the weights of the facing sides), and per vertex
/// the sum of its 3D angles.
struct Corners {
    std::vector<std::array<double, 3>> half_cotangents;
    std::vector<double> angle_sums;
};

Corners corners_of(const Region& region) {
    Corners corners{{}, std::vector<double>(region.positions.size(), 0.0)};
    corners.half_cotangents.reserve(region.triangles.size());
    for (const Triangle& t : region.triangles) {
        const Vec3 sides[] = {region.position(t[2]) - region.position(t[1]),
                              region.position(t[0]) - region.position(t[2]),
                              region.position(t[1]) - region.position(t[0])};
        const double doubled_area = sides[0].cross(sides[1]).norm();
        auto& cotangents = corners.half_cotangents.emplace_back();
        for (std::size_t i = 0; i < 3; ++i) {
            const double dot = -sides[(i + 1) % 3].dot(sides[(i + 2) % 3]);
            corners.angle_sums[static_cast<std::size_t>(t[i])] += std::atan2(doubled_area, dot);
            cotangents[i] = 0.5 * dot / doubled_area;
        }
    }
    return corners;
}

/// The cotangent Laplacian between inner vertices in this order, lower triangle.
SparseMatrix inner_laplacian(const Region& region, const Corners& corners,
                             const std::vector<Index>& inner) {
    const auto count = static_cast<Index>(inner.size());
    const auto index = inverse(inner, region.positions.size());
    SparseMatrix A_ii(count, count);
    A_ii.reserve(static_cast<Eigen::Index>(4) * count);
    std::vector<Index> below;
    for (Index k = 0; k < count; ++k) {
        below.clear();
        for (const Index w : region.half_edges.ring(inner[static_cast<std::size_t>(k)])) {
            const Index row = index[at(w)];
            if (row > k) below.push_back(row);
        }
        std::sort(below.begin(), below.end());
        A_ii.startVec(k);
        A_ii.insertBackByOuterInner(k, k) = 0.0;
        for (const Index row : below) A_ii.insertBackByOuterInner(k, row) = 0.0;
    }
    A_ii.finalize();
    double* values = A_ii.valuePtr();
    const auto* begin = A_ii.outerIndexPtr();
    const auto* rows = A_ii.innerIndexPtr();
    for (std::size_t t = 0; t < region.triangles.size(); ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
            const double weight = corners.half_cotangents[t][i];
            const Index a = index[at(region.triangles[t][(i + 1) % 3])];
            const Index b = index[at(region.triangles[t][(i + 2) % 3])];
            if (a >= 0) values[begin[a]] += weight;  // the diagonal comes first
            if (b >= 0) values[begin[b]] += weight;
            if (a < 0 || b < 0) continue;
            const auto [column, row] = std::minmax(a, b);
            values[std::lower_bound(rows + begin[column], rows + begin[column + 1], row) - rows] -=
                weight;
        }
    }
    return A_ii;
}

/// Scale factors u of the conformal map that keeps border lengths: A_II u = -Omega, u = 0 outside.
std::vector<double> conformal_scale(const Region& region, const Dissection& dissection,
                                    const Corners& corners) {
    const Elimination elimination =
        elimination_of(dissection, [&](Index v) { return !region.half_edges.on_border(v); });
    const std::vector<Index>& inner = elimination.vertices;
    std::vector<double> u(region.positions.size(), 0.0);
    if (inner.empty()) return u;
    Eigen::VectorXd omega(static_cast<Eigen::Index>(inner.size()));
    for (std::size_t k = 0; k < inner.size(); ++k) {
        omega[static_cast<Eigen::Index>(k)] =
            2.0 * pi - corners.angle_sums[static_cast<std::size_t>(inner[k])];
    }
    const SparseMatrix laplacian = inner_laplacian(region, corners, inner);
    MultifrontalLdlt solver;
    solver.analyse(laplacian, elimination.blocks);
    if (!solver.factor(laplacian, Progress()) || solver.negative_pivots() > 0)
        throw Error(ErrorCode::solver_failed, "a linear system is not positive definite");
    const Eigen::VectorXd solution = solver.solve(-omega);
    for (std::size_t k = 0; k < inner.size(); ++k) {
        u[static_cast<std::size_t>(inner[k])] = solution[static_cast<Eigen::Index>(k)];
    }
    return u;
}

std::vector<double> curvature_turning(const Region& region, const Dissection& dissection,
                                      const Corners& corners) {
    const auto u = conformal_scale(region, dissection, corners);
    std::vector<double> flux(region.positions.size(), 0.0);  // A u
    for (std::size_t t = 0; t < region.triangles.size(); ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto a = static_cast<std::size_t>(region.triangles[t][(i + 1) % 3]);
            const auto b = static_cast<std::size_t>(region.triangles[t][(i + 2) % 3]);
            const double flow = corners.half_cotangents[t][i] * (u[a] - u[b]);
            flux[a] += flow;
            flux[b] -= flow;
        }
    }
    std::vector<double> turning;
    for (const Index v : region.border) {
        turning.push_back(pi - corners.angle_sums[static_cast<std::size_t>(v)] +
                          flux[static_cast<std::size_t>(v)]);
    }
    return turning;
}

/// The angle at v of triangle (v, w, other), flattened in the geodesic polar map of w: spokes keep
/// their lengths, the angle at w is scaled so that the ring closes.
double polar_angle(const Region& region, Index v, Index w, Index other, double angle_sum_w) {
    const double phi = corner_angle(region, w, v, other) * 2.0 * pi / angle_sum_w;
    const Vec2 at_v(region.distance(w, v), 0.0);
    const Vec2 at_other = region.distance(w, other) * Vec2(std::cos(phi), std::sin(phi));
    return angle_at<Vec2>(at_v, Vec2::Zero(), at_other);
}

/// The paper's gamma: the mean of both polar angles, where both neighbours are inside.
double averaged_conformal_angle(const Region& region, const std::vector<double>& sums, Index v,
                                Index a, Index b) {
    double sum = 0.0;
    int rings_used = 0;
    for (const auto& [w, other] : {std::pair(a, b), std::pair(b, a)}) {
        if (region.half_edges.on_border(w)) continue;
        sum += polar_angle(region, v, w, other, sums[static_cast<std::size_t>(w)]);
        ++rings_used;
    }
    return rings_used > 0 ? sum / rings_used : corner_angle(region, v, a, b);
}

/// Spreads what the turning lacks to 2 pi over the border, in proportion to its length.
void close_turning(const Region& region, std::vector<double>& turning) {
    const auto lengths = border_lengths(region);
    const double total = std::accumulate(lengths.begin(), lengths.end(), 0.0);
    const double lack = 2.0 * pi - std::accumulate(turning.begin(), turning.end(), 0.0);
    for (std::size_t i = 0; i < turning.size(); ++i) {
        const double before = lengths[(i + lengths.size() - 1) % lengths.size()];
        turning[i] += lack * 0.5 * (before + lengths[i]) / total;
    }
}

}  // namespace

BorderAngles border_angles(const Region& region, const Dissection& dissection, AngleRule rule) {
    const Corners triangles = corners_of(region);
    const auto& sums = triangles.angle_sums;
    BorderAngles result;
    for (const Index v : region.border) {
        const auto ring = region.half_edges.ring(v);
        result.corners.emplace_back();
        for (std::size_t j = 0; j + 1 < ring.size(); ++j) {
            result.corners.back().push_back(
                rule == AngleRule::curvature
                    ? corner_angle(region, v, ring[j], ring[j + 1])
                    : averaged_conformal_angle(region, sums, v, ring[j], ring[j + 1]));
        }
    }
    if (rule == AngleRule::curvature) {
        result.turning = curvature_turning(region, dissection, triangles);
    } else {
        for (const auto& corners : result.corners) {
            result.turning.push_back(pi - std::accumulate(corners.begin(), corners.end(), 0.0));
        }
    }
    close_turning(region, result.turning);
    for (std::size_t i = 0; i < result.corners.size(); ++i) {
        auto& corners = result.corners[i];
        const double scale = std::max(pi - result.turning[i], tolerance::least_border_angle) /
                             std::accumulate(corners.begin(), corners.end(), 0.0);
        for (double& corner : corners) corner *= scale;
    }
    return result;
}

}  // namespace lastflat
