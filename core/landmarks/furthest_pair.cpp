#include "core/landmarks/furthest_pair.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lastflat {
namespace {

std::pair<std::size_t, std::size_t> furthest_vertices(const Points3& line) {
    std::pair<std::size_t, std::size_t> best{0, 0};
    double most = 0.0;
    const std::size_t step = std::max<std::size_t>(1, line.size() / 1000);
    for (std::size_t i = 0; i < line.size(); i += step) {
        for (std::size_t j = i + 1; j < line.size(); ++j) {
            const double square = (line[i] - line[j]).squaredNorm();
            if (square <= most) continue;
            most = square;
            best = {i, j};
        }
    }
    return best;
}

/// A closed line by arc length.
class ClosedLine {
public:
    explicit ClosedLine(const Points3& line) : line_(line) {
        for (std::size_t i = 1; i < line.size(); ++i)
            along_.push_back(along_.back() + (line[i] - line[i - 1]).norm());
    }
    [[nodiscard]] double along(std::size_t vertex) const { return along_[vertex]; }
    [[nodiscard]] Vec3 at(double s) const {
        s -= along_.back() * std::floor(s / along_.back());
        const auto next = std::upper_bound(along_.begin() + 1, along_.end() - 1, s);
        const auto i = static_cast<std::size_t>(next - along_.begin());
        const double share = (s - along_[i - 1]) / (along_[i] - along_[i - 1]);
        return line_[i - 1] + share * (line_[i] - line_[i - 1]);
    }

private:
    const Points3& line_;
    std::vector<double> along_{0.0};
};

/// The top of the parabola through the distances from `other` around `s`.
double top_of_parabola(const ClosedLine& line, double s, double reach, const Vec3& other) {
    constexpr int samples = 32, most_rounds = 20;
    for (int round = 0; round < most_rounds; ++round) {
        Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
        Vec3 right = Vec3::Zero();
        for (int k = -samples; k <= samples; ++k) {
            const double x = static_cast<double>(k) / samples;
            const Vec3 row(1.0, x, x * x);
            normal += row * row.transpose();
            right += (line.at(s + x * reach) - other).norm() * row;
        }
        const Vec3 fit = normal.partialPivLu().solve(right);
        if (!(fit[2] < 0.0)) return s;
        const double step = std::clamp(-0.5 * fit[1] / fit[2], -0.5, 0.5) * reach;
        s += step;
        if (std::abs(step) < 1e-3 * reach) break;
    }
    return s;
}

}  // namespace

std::pair<Vec3, Vec3> furthest_pair(const Points3& points, const Vec3& forward) {
    constexpr double heel_share = 0.13, toe_share = 0.04;
    auto [heel, toe] = furthest_vertices(points);
    if (forward.dot(points[toe] - points[heel]) < 0.0) std::swap(heel, toe);
    const ClosedLine line(points);
    const double apart = (points[heel] - points[toe]).norm();
    const Vec3 back =
        line.at(top_of_parabola(line, line.along(heel), heel_share * apart, points[toe]));
    const Vec3 front = line.at(top_of_parabola(line, line.along(toe), toe_share * apart, back));
    return {back, front};
}

}  // namespace lastflat
