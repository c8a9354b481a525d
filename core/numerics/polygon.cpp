#include "core/numerics/polygon.h"

#include <numeric>

namespace lastflat {

double signed_area(const Points2& polygon) {
    double doubled = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        doubled += cross(polygon[i] - polygon[0], polygon[(i + 1) % polygon.size()] - polygon[0]);
    }
    return 0.5 * doubled;
}

std::vector<Index> convex_hull(const Points2& points) {
    std::vector<Index> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    const auto at = [&](Index i) -> const Vec2& { return points[static_cast<std::size_t>(i)]; };
    std::sort(order.begin(), order.end(), [&](Index i, Index j) {
        if (at(i).x() != at(j).x()) return at(i).x() < at(j).x();
        if (at(i).y() != at(j).y()) return at(i).y() < at(j).y();
        return i < j;
    });
    std::vector<Index> hull;
    const auto extend = [&](Index next, std::size_t base) {
        while (hull.size() >= base + 2 &&
               doubled_area(at(hull[hull.size() - 2]), at(hull.back()), at(next)) <= 0.0) {
            hull.pop_back();
        }
        hull.push_back(next);
    };
    for (const Index i : order) extend(i, 0);
    const std::size_t upper = hull.size() - 1;
    for (auto i = order.rbegin() + 1; i != order.rend(); ++i) extend(*i, upper);
    hull.pop_back();
    return hull;
}

namespace {

bool segments_meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
    const double c_side = doubled_area(a, b, c);
    const double d_side = doubled_area(a, b, d);
    const double a_side = doubled_area(c, d, a);
    const double b_side = doubled_area(c, d, b);
    if (c_side == 0.0 && d_side == 0.0) {  // on one line: they meet if their extents do
        return std::max(std::min(a.x(), b.x()), std::min(c.x(), d.x())) <=
                   std::min(std::max(a.x(), b.x()), std::max(c.x(), d.x())) &&
               std::max(std::min(a.y(), b.y()), std::min(c.y(), d.y())) <=
                   std::min(std::max(a.y(), b.y()), std::max(c.y(), d.y()));
    }
    return c_side * d_side <= 0.0 && a_side * b_side <= 0.0;
}

}  // namespace

std::vector<Crossing> self_crossings(const Points2& polygon) {
    const auto n = static_cast<Index>(polygon.size());
    const auto at = [&](Index i) -> const Vec2& {
        return polygon[static_cast<std::size_t>(i % n)];
    };
    const auto left = [&](Index i) { return std::min(at(i).x(), at(i + 1).x()); };
    const auto right = [&](Index i) { return std::max(at(i).x(), at(i + 1).x()); };
    std::vector<Index> order(polygon.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
              [&](Index i, Index j) { return left(i) != left(j) ? left(i) < left(j) : i < j; });
    std::vector<Crossing> crossings;
    for (std::size_t i = 0; i < order.size(); ++i) {
        for (std::size_t j = i + 1; j < order.size() && left(order[j]) <= right(order[i]); ++j) {
            const Index a = std::min(order[i], order[j]);
            const Index b = std::max(order[i], order[j]);
            if (b == a + 1 || (a == 0 && b == n - 1)) continue;
            if (segments_meet(at(a), at(a + 1), at(b), at(b + 1))) crossings.push_back({a, b});
        }
    }
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& x, const Crossing& y) {
        return x.a != y.a ? x.a < y.a : x.b < y.b;
    });
    return crossings;
}

}  // namespace lastflat
