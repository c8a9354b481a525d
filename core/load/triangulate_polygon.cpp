#include "core/load/triangulate_polygon.h"

#include <Eigen/Geometry>
#include <array>

#include "core/numerics/polygon.h"

namespace lastflat {
namespace {

/// Twice the polygon's area vector (Newell): its direction is the mean plane's normal.
Vec3 area_vector(const Points3& positions, const std::vector<Index>& loop) {
    const auto at = [&](std::size_t i) { return positions[static_cast<std::size_t>(loop[i])]; };
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
        sum += (at(i) - at(0)).cross(at(i + 1) - at(0));
    }
    return sum;
}

bool inside(const Vec2& p, const Vec2& a, const Vec2& b, const Vec2& c) {
    return doubled_area(a, b, p) >= 0 && doubled_area(b, c, p) >= 0 && doubled_area(c, a, p) >= 0;
}

/// A polygon in its plane that loses its ears one by one; the ears left are kept up to date.
class EarClipper {
public:
    explicit EarClipper(Points2 flat) : flat_(std::move(flat)), quality_(flat_.size()) {
        for (std::size_t i = 0; i < flat_.size(); ++i) left_.push_back(i);
        for (std::size_t i = 0; i < left_.size(); ++i) quality_[left_[i]] = quality_at(i);
    }
    [[nodiscard]] std::size_t size() const { return left_.size(); }

    /// Cuts off the best ear, or any corner if there is none; returns its three corners.
    std::array<std::size_t, 3> clip() {
        std::size_t ear = 0;
        for (std::size_t i = 1; i < left_.size(); ++i) {
            if (quality_[left_[i]] > quality_[left_[ear]]) ear = i;
        }
        const std::array<std::size_t, 3> corners{corner(ear, -1), corner(ear, 0), corner(ear, 1)};
        left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
        if (left_.size() > 3) {  // only the neighbours' ears change, unless a blocker went
            const std::size_t n = left_.size();
            for (const std::size_t i : {(ear + n - 1) % n, ear % n})
                quality_[left_[i]] = quality_at(i);
        }
        return corners;
    }

private:
    [[nodiscard]] std::size_t corner(std::size_t i, int step) const {
        const std::size_t n = left_.size();
        return left_[(i + n + static_cast<std::size_t>(step + 1) - 1) % n];
    }

    /// Height of the ear over its cut, as a share: large for short diagonals, 0 for no ear.
    [[nodiscard]] double quality_at(std::size_t i) const {
        const std::size_t before = corner(i, -1), here = corner(i, 0), after = corner(i, 1);
        const Vec2 &a = flat_[before], &b = flat_[here], &c = flat_[after];
        const double area = doubled_area(a, b, c);
        if (area <= 0.0) return 0.0;
        for (const std::size_t other : left_) {
            if (other != before && other != here && other != after &&
                inside(flat_[other], a, b, c)) {
                return 0.0;
            }
        }
        return area / (c - a).squaredNorm();
    }

    Points2 flat_;
    std::vector<std::size_t> left_;
    std::vector<double> quality_;
};

}  // namespace

std::vector<Triangle> triangulate_polygon(const Points3& positions,
                                          std::span<const Index> corners) {
    std::vector<Index> loop;
    for (const Index corner : corners) {
        if (loop.empty() || loop.back() != corner) loop.push_back(corner);
    }
    while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
    if (loop.size() < 3) return {};
    if (loop.size() == 3) return {{loop[0], loop[1], loop[2]}};

    const Vec3 normal = area_vector(positions, loop).normalized();
    const Vec3 x = normal.unitOrthogonal();
    const Vec3 y = normal.cross(x);
    Points2 flat;
    for (const Index corner : loop) {
        const Vec3 p = positions[static_cast<std::size_t>(corner)] -
                       positions[static_cast<std::size_t>(loop[0])];
        flat.emplace_back(p.dot(x), p.dot(y));
    }
    EarClipper clipper(std::move(flat));
    std::vector<Triangle> triangles;
    while (clipper.size() > 2) {
        const auto ear = clipper.clip();
        triangles.push_back({loop[ear[0]], loop[ear[1]], loop[ear[2]]});
    }
    return triangles;
}

}  // namespace lastflat
