// Based on: Sawhney, Crane, "Boundary First Flattening", TOG 2017, and Kim, Kim, "Geodesic-Fan
// Based Mesh Parameterization in Shoe CAD System".
#include "core/border/border_angles.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/numerics/polygon.h"
#include "core/numerics/sparse_solvers.h"

namespace lastflat {
namespace {

using std::numbers::pi;

double corner_angle(const Region& region, Index apex, Index a, Index b) {
    return angle_at(region.position(apex), region.position(a), region.position(b));
}

/// The 3D angles around every vertex, summed.
std::vector<double> angle_sums(const Region& region) {
    std::vector<double> sums(region.positions.size(), 0.0);
    for (const Triangle& t : region.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            sums[static_cast<std::size_t>(t[i])] +=
                corner_angle(region, t[i], t[(i + 1) % 3], t[(i + 2) % 3]);
        }
    }
    return sums;
}

/// Half the cotangent of the angle at t[i]: the weight of the side that faces it.
double half_cotangent(const Region& region, const Triangle& t, std::size_t i) {
    const Vec3 a = region.position(t[(i + 1) % 3]) - region.position(t[i]);
    const Vec3 b = region.position(t[(i + 2) % 3]) - region.position(t[i]);
    return 0.5 * a.dot(b) / a.cross(b).norm();
}

/// Scale factors u of the conformal map that keeps border lengths: A_II u = -Omega, u = 0 outside.
std::vector<double> conformal_scale(const Region& region, const std::vector<double>& sums,
                                    const std::vector<bool>& on_border) {
    std::vector<Index> unknown(region.positions.size(), -1);
    Index count = 0;
    for (std::size_t v = 0; v < unknown.size(); ++v) {
        if (!on_border[v]) unknown[v] = count++;
    }
    std::vector<double> u(region.positions.size(), 0.0);
    if (count == 0) return u;
    std::vector<Eigen::Triplet<double>> entries;
    for (const Triangle& t : region.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Index a = unknown[static_cast<std::size_t>(t[(i + 1) % 3])];
            const Index b = unknown[static_cast<std::size_t>(t[(i + 2) % 3])];
            const double weight = half_cotangent(region, t, i);
            if (a >= 0) entries.emplace_back(a, a, weight);
            if (b >= 0) entries.emplace_back(b, b, weight);
            if (a >= 0 && b >= 0) entries.emplace_back(std::max(a, b), std::min(a, b), -weight);
        }
    }
    SparseMatrix A_ii(count, count);
    A_ii.setFromTriplets(entries.begin(), entries.end());
    Eigen::VectorXd omega(count);
    for (std::size_t v = 0; v < unknown.size(); ++v) {
        if (unknown[v] >= 0) omega[unknown[v]] = 2.0 * pi - sums[v];
    }
    const Eigen::VectorXd solution = solve_spd(A_ii, -omega);
    for (std::size_t v = 0; v < unknown.size(); ++v) {
        if (unknown[v] >= 0) u[v] = solution[unknown[v]];
    }
    return u;
}

std::vector<double> curvature_turning(const Region& region, const OneRings& rings,
                                      const std::vector<double>& sums) {
    std::vector<bool> on_border(region.positions.size());
    for (std::size_t v = 0; v < on_border.size(); ++v) {
        on_border[v] = rings.on_border(static_cast<Index>(v));
    }
    const auto u = conformal_scale(region, sums, on_border);
    std::vector<double> flux(region.positions.size(), 0.0);  // A u
    for (const Triangle& t : region.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto a = static_cast<std::size_t>(t[(i + 1) % 3]);
            const auto b = static_cast<std::size_t>(t[(i + 2) % 3]);
            const double flow = half_cotangent(region, t, i) * (u[a] - u[b]);
            flux[a] += flow;
            flux[b] -= flow;
        }
    }
    std::vector<double> turning;
    for (const Index v : region.border) {
        turning.push_back(pi - sums[static_cast<std::size_t>(v)] +
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
double averaged_conformal_angle(const Region& region, const OneRings& rings,
                                const std::vector<double>& sums, Index v, Index a, Index b) {
    double sum = 0.0;
    int rings_used = 0;
    for (const auto& [w, other] : {std::pair(a, b), std::pair(b, a)}) {
        if (rings.on_border(w)) continue;
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

BorderAngles border_angles(const Region& region, const OneRings& rings, AngleRule rule) {
    const auto sums = angle_sums(region);
    BorderAngles result;
    for (const Index v : region.border) {
        const auto ring = rings.of(v);
        result.corners.emplace_back();
        for (std::size_t j = 0; j + 1 < ring.size(); ++j) {
            result.corners.back().push_back(
                rule == AngleRule::curvature
                    ? corner_angle(region, v, ring[j], ring[j + 1])
                    : averaged_conformal_angle(region, rings, sums, v, ring[j], ring[j + 1]));
        }
    }
    if (rule == AngleRule::curvature) {
        result.turning = curvature_turning(region, rings, sums);
    } else {
        for (const auto& corners : result.corners) {
            result.turning.push_back(pi - std::accumulate(corners.begin(), corners.end(), 0.0));
        }
    }
    close_turning(region, result.turning);
    for (std::size_t i = 0; i < result.corners.size(); ++i) {
        auto& corners = result.corners[i];
        const double scale =
            (pi - result.turning[i]) / std::accumulate(corners.begin(), corners.end(), 0.0);
        for (double& corner : corners) corner *= scale;
    }
    return result;
}

}  // namespace lastflat
