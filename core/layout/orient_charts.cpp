#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/layout/base_line.h"
#include "core/layout/sheet.h"

namespace lastflat {
namespace {

const CurveRun* run_of(const Region& region, std::initializer_list<const char*> names) {
    for (const char* name : names) {
        for (const CurveRun& run : region.runs) {
            if (run.curve == name && !run.closed()) return &run;
        }
    }
    return nullptr;
}

struct Patch {
    Vec3 centre;
    Vec2 flat_centre;
    double area;
};

std::vector<Patch> patches(const Region& region, const Chart& chart) {
    std::vector<Patch> result;
    for (const Triangle& t : region.triangles) {
        Patch patch{Vec3::Zero(), Vec2::Zero(), 0.0};
        for (const Index v : t) {
            patch.centre += region.position(v) / 3.0;
            patch.flat_centre += chart.uv[static_cast<std::size_t>(v)] / 3.0;
        }
        patch.area = 0.5 * (region.position(t[1]) - region.position(t[0]))
                               .cross(region.position(t[2]) - region.position(t[0]))
                               .norm();
        result.push_back(patch);
    }
    return result;
}

/// The flat direction along which the place along `axis` grows.
Vec2 direction_of(const Vec3& axis, const std::vector<Patch>& pieces) {
    double area = 0.0, mean_place = 0.0;
    Vec2 mean_flat = Vec2::Zero();
    for (const Patch& p : pieces) {
        area += p.area;
        mean_place += p.area * p.centre.dot(axis);
        mean_flat += p.area * p.flat_centre;
    }
    mean_place /= area;
    mean_flat /= area;
    Vec2 direction = Vec2::Zero();
    for (const Patch& p : pieces) {
        direction += p.area * (p.centre.dot(axis) - mean_place) * (p.flat_centre - mean_flat);
    }
    return direction;
}

}  // namespace

std::optional<BaseLine> named_base_line(const Region& region) {
    const CurveRun* heel = run_of(region, {"heel"});
    const CurveRun* front = run_of(region, {"centre_front", "toe", "instep"});
    if (heel == nullptr || front == nullptr) return std::nullopt;
    BaseLine best{heel->vertices.front(), front->vertices.front()};
    for (const Index seat : {heel->vertices.front(), heel->vertices.back()}) {
        for (const Index toe : {front->vertices.front(), front->vertices.back()}) {
            if (region.distance(seat, toe) > region.distance(best.seat, best.toe)) best = {seat, toe};
        }
    }
    return best;
}

Vec3 long_axis(const std::vector<Region>& regions) {
    double area = 0.0;
    Vec3 mean = Vec3::Zero();
    const auto for_triangles = [&](auto visit) {
        for (const Region& region : regions) {
            for (const Triangle& t : region.triangles) {
                const Vec3 &a = region.position(t[0]), &b = region.position(t[1]), &c = region.position(t[2]);
                visit(Vec3((a + b + c) / 3.0), 0.5 * (b - a).cross(c - a).norm());
            }
        }
    };
    for_triangles([&](const Vec3& centre, double a) {
        area += a;
        mean += a * centre;
    });
    mean /= area;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for_triangles([&](const Vec3& centre, double a) {
        covariance += a * (centre - mean) * (centre - mean).transpose();
    });
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
    Vec3 axis = eigen.eigenvectors().col(2);
    double skew = 0.0;  // the longer tail decides the sign, so that it turns with the last
    for_triangles([&](const Vec3& centre, double a) { skew += a * std::pow((centre - mean).dot(axis), 3); });
    return skew < 0.0 ? Vec3(-axis) : axis;
}

void orient_charts(const std::vector<Region>& regions, std::vector<Chart>& charts) {
    const Vec3 axis = long_axis(regions);
    for (std::size_t r = 0; r < regions.size(); ++r) {
        Points2& uv = charts[r].uv;
        Vec2 base = direction_of(axis, patches(regions[r], charts[r]));
        if (const auto line = named_base_line(regions[r])) {
            base = uv[static_cast<std::size_t>(line->toe)] - uv[static_cast<std::size_t>(line->seat)];
        }
        const double length = base.norm();
        const Vec2 along = length > 0.0 ? Vec2(base / length) : Vec2::UnitX();
        Vec2 low(HUGE_VAL, HUGE_VAL);
        for (Vec2& p : uv) {
            p = {along.dot(p), along.x() * p.y() - along.y() * p.x()};
            low = low.cwiseMin(p);
        }
        for (Vec2& p : uv) p -= low;
    }
}

}  // namespace lastflat
