#include "core/landmarks/bare_last.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/numerics/geometry.h"

namespace lastflat {
namespace {

/// The directions of the flattest sides, across the long axis; the flattest first.
std::vector<Vec3> flat_sides(const std::vector<BareFace>& faces, const Vec3& axis) {
    constexpr std::size_t directions = 360, apart = 40;
    const Vec3 first = axis.unitOrthogonal(), second = axis.cross(first);
    std::vector<Vec3> all;
    std::vector<double> flatness(directions, 0.0);
    for (std::size_t i = 0; i < directions; ++i) {
        const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / directions;
        all.emplace_back(std::cos(angle) * first + std::sin(angle) * second);
        for (const BareFace& face : faces) {
            const double along = std::max(0.0, face.normal.dot(all[i]));
            const double fourth = along * along * along * along;
            flatness[i] += face.area * fourth * fourth;
        }
    }
    std::vector<std::size_t> peaks;
    for (std::size_t i = 0; i < directions; ++i) {
        bool highest = true;
        for (std::size_t k = 1; k <= apart; ++k) {
            highest = highest && flatness[i] > flatness[(i + k) % directions] &&
                      flatness[i] >= flatness[(i + directions - k) % directions];
        }
        if (highest) peaks.push_back(i);
    }
    std::sort(peaks.begin(), peaks.end(),
              [&](std::size_t a, std::size_t b) { return flatness[a] > flatness[b]; });
    std::vector<Vec3> sides;
    sides.reserve(peaks.size());
    for (const std::size_t i : peaks) sides.push_back(all[i]);
    return sides;
}

/// Upright with the given side down; the cone, highest of all, stands over the heel.
LastFrame standing(const std::vector<BareFace>& faces, const Vec3& mean, const Vec3& axis,
                   const Vec3& down) {
    std::vector<const BareFace*> by_height;
    double all = 0.0;
    for (const BareFace& face : faces) {
        by_height.push_back(&face);
        all += face.area;
    }
    std::sort(by_height.begin(), by_height.end(), [&](const BareFace* a, const BareFace* b) {
        return down.dot(a->centre) < down.dot(b->centre);
    });
    double cone = 0.0, highest = 0.0;
    for (std::size_t f = 0; f < by_height.size() && highest < 0.1 * all; ++f) {
        highest += by_height[f]->area;
        cone += by_height[f]->area * axis.dot(by_height[f]->centre - mean);
    }
    return {cone > 0.0 ? Vec3(-axis) : axis, -down};
}

}  // namespace

void fail_search(const std::string& why) {
    throw Error(ErrorCode::region_invalid,
                "the request does not say how the last is cut, and that cannot be found: " + why +
                    "; name the curves, cuts and regions")
        .at_option({"curves"});
}

std::vector<BareFace> bare_faces(const SurfaceMesh& surface) {
    std::vector<BareFace> faces;
    for (const auto face : surface.mesh.faces()) {
        const Triangle t = corners_of(surface, face.idx());
        const Vec3 normal = doubled_area_vector(surface, t);
        faces.push_back({centroid(surface, t), normal.normalized(), 0.5 * normal.norm()});
    }
    return faces;
}

std::vector<LastFrame> last_frames(const std::vector<BareFace>& faces) {
    double area = 0.0;
    Vec3 mean = Vec3::Zero();
    for (const BareFace& face : faces) {
        area += face.area;
        mean += face.area * face.centre;
    }
    mean /= area;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const BareFace& face : faces)
        spread += face.area * (face.centre - mean) * (face.centre - mean).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
    if (!(axes.eigenvalues()[2] > 2.0 * axes.eigenvalues()[1]))
        fail_search("it is not long enough for a last");
    const Vec3 axis = axes.eigenvectors().col(2);
    std::vector<LastFrame> frames;
    for (const Vec3& down : flat_sides(faces, axis))
        frames.push_back(standing(faces, mean, axis, down));
    return frames;
}

/// The faces of a set that hang together with the given one.
std::vector<bool> piece_of(const SurfaceMesh& surface, const std::vector<bool>& set,
                           std::size_t seed) {
    std::vector<bool> piece(set.size(), false);
    std::vector<std::size_t> stack{seed};
    piece[seed] = true;
    while (!stack.empty()) {
        const OpenMesh::FaceHandle face(static_cast<int>(stack.back()));
        stack.pop_back();
        for (const auto neighbour : surface.mesh.ff_range(face)) {
            const auto n = static_cast<std::size_t>(neighbour.idx());
            if (!set[n] || piece[n]) continue;
            piece[n] = true;
            stack.push_back(n);
        }
    }
    return piece;
}

Points3 positions_of(const SurfaceMesh& surface, const std::vector<Index>& line) {
    Points3 points;
    for (const Index v : line) points.push_back(surface.position(v));
    return points;
}

}  // namespace lastflat
