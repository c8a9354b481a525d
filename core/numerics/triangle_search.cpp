#include "core/numerics/triangle_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/geometry.h"

namespace lastflat {
namespace {

/// Every third bit of the result is one of the lowest ten.
std::uint64_t spread(double share) {
    auto bits = static_cast<std::uint64_t>(std::clamp(share, 0.0, 1.0) * 1023.0);
    std::uint64_t result = 0;
    for (int i = 0; i < 10; ++i) result |= (bits >> i & 1U) << (3 * i);
    return result;
}

}  // namespace

Vec3 nearest_weights(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point) {
    const Vec3 ab = b - a, ac = c - a, ap = point - a;
    const double bb = ab.squaredNorm(), bc = ab.dot(ac), cc = ac.squaredNorm();
    const double pb = ap.dot(ab), pc = ap.dot(ac), determinant = bb * cc - bc * bc;
    if (determinant > 0.0) {
        const double v = (cc * pb - bc * pc) / determinant, w = (bb * pc - bc * pb) / determinant;
        if (v >= 0.0 && w >= 0.0 && v + w <= 1.0) return {1.0 - v - w, v, w};
    }
    Vec3 best = Vec3::Zero();
    double least = std::numeric_limits<double>::infinity();
    const std::array<const Vec3*, 3> corners{&a, &b, &c};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const double to = nearest_share(*corners[i], *corners[j], point), from = 1.0 - to;
        const double distance = (from * *corners[i] + to * *corners[j] - point).squaredNorm();
        if (distance >= least) continue;
        least = distance;
        best.setZero();
        best[static_cast<Eigen::Index>(i)] = from;
        best[static_cast<Eigen::Index>(j)] = to;
    }
    return best;
}

TriangleSearch::Order TriangleSearch::order_of(const Triangulation& surface) {
    Box3 all;
    std::vector<Box3> boxes;
    for (const Triangle& t : surface.triangles) {
        Box3 box;
        for (const Index v : t) box.extend(surface.position(v));
        all.extend(box);
        boxes.push_back(box);
    }
    std::vector<std::pair<std::uint64_t, Index>> keys;
    const Vec3 sizes = all.sizes().cwiseMax(std::numeric_limits<double>::min());
    for (std::size_t t = 0; t < boxes.size(); ++t) {
        const Vec3 share = (boxes[t].center() - all.min()).cwiseQuotient(sizes);
        keys.emplace_back(spread(share.x()) | spread(share.y()) << 1 | spread(share.z()) << 2,
                          static_cast<Index>(t));
    }
    std::sort(keys.begin(), keys.end());
    Order order{{}, {}, all.isEmpty() ? 0.0 : all.diagonal().norm()};
    for (const auto& [key, triangle] : keys) {
        order.triangles.push_back(triangle);
        order.boxes.push_back(boxes[static_cast<std::size_t>(triangle)]);
    }
    return order;
}

TriangleSearch::TriangleSearch(const Triangulation& surface)
    : TriangleSearch(surface, order_of(surface)) {}

TriangleSearch::TriangleSearch(const Triangulation& surface, Order order)
    : surface_(surface),
      triangles_(std::move(order.triangles)),
      tree_(order.boxes),
      size_(order.size) {}

TriangleSearch::Nearest TriangleSearch::nearest(const Vec3& position) const {
    Nearest best{-1, {}, {}, std::numeric_limits<double>::infinity()};
    // Wider and wider until the best is surely within reach.
    for (double reach = 1e-3 * size_; std::isfinite(reach); reach *= 4.0) {
        const Box3 box(position - Vec3::Constant(reach), position + Vec3::Constant(reach));
        tree_.find(box, [&](Index i) {
            const Index triangle = triangles_[static_cast<std::size_t>(i)];
            const Triangle& t = surface_.triangles[static_cast<std::size_t>(triangle)];
            const Vec3 &a = surface_.position(t[0]), &b = surface_.position(t[1]),
                       &c = surface_.position(t[2]);
            const Vec3 weights = nearest_weights(a, b, c, position);
            const Vec3 nearest = weights[0] * a + weights[1] * b + weights[2] * c;
            const double distance = (nearest - position).norm();
            if (distance < best.distance) best = {triangle, weights, nearest, distance};
            return false;
        });
        if (best.distance <= reach) break;
    }
    return best;
}

}  // namespace lastflat
