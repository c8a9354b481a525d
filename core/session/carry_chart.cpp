#include "core/session/carry_chart.h"

#include "core/numerics/triangle_search.h"

namespace lastflat {
namespace {

/// Where the linear map of an old triangle takes a point that is seen along its normal.
Vec2 mapped(const Region& old, const Chart& chart, Index triangle, const Vec3& point) {
    const Triangle& t = old.triangles[at(triangle)];
    const Vec3 &a = old.position(t[0]), u = old.position(t[1]) - a, v = old.position(t[2]) - a;
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v);
    const double det = uu * vv - uv * uv;
    const Vec3 way = point - a;
    const double p = (vv * way.dot(u) - uv * way.dot(v)) / det;
    const double q = (uu * way.dot(v) - uv * way.dot(u)) / det;
    const Vec2& origin = chart.uv[at(t[0])];
    return origin + p * (chart.uv[at(t[1])] - origin) + q * (chart.uv[at(t[2])] - origin);
}

}  // namespace

std::optional<Chart> carried_chart(const Region& old, const Chart& chart, const Region& region) {
    const TriangleSearch search(old);
    Chart carried;
    carried.uv.reserve(region.positions.size());
    for (const Vec3& point : region.positions) {
        carried.uv.push_back(mapped(old, chart, search.nearest(point).triangle, point));
        if (!carried.uv.back().allFinite()) return std::nullopt;
    }
    if (!flipped_triangles(region, carried.uv).empty()) return std::nullopt;
    if (!border_crossings(region, carried.uv).empty()) return std::nullopt;
    return carried;
}

}  // namespace lastflat
