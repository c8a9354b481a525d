#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/cut/border_segments.h"
#include "core/layout/base_line.h"
#include "core/layout/sheet.h"
#include "core/numerics/geometry.h"
#include "core/request.h"

namespace lastflat {
namespace {

const BorderSegment* segment_of(const std::vector<BorderSegment>& segments, const char* name) {
    for (const BorderSegment& segment : segments) {
        if (segment.curve == name && segment.first != segment.last) return &segment;
    }
    return nullptr;
}

/// The whole centre line in front, from its parts if it is given in parts.
std::optional<BorderSegment> front_segment(const std::vector<BorderSegment>& segments) {
    if (const auto* whole = segment_of(segments, curve_name::centre_front)) return *whole;
    const auto* toe = segment_of(segments, curve_name::toe);
    const auto* instep = segment_of(segments, curve_name::instep);
    if (toe == nullptr || instep == nullptr) return std::nullopt;
    if (toe->last == instep->first)
        return BorderSegment{curve_name::centre_front, toe->first, instep->last};
    if (instep->last == toe->first)
        return BorderSegment{curve_name::centre_front, instep->first, toe->last};
    return std::nullopt;
}

/// Length of the border from one of its vertices, counter-clockwise, to another.
double border_length(const Region& region, Index from, Index to) {
    const std::size_t n = region.border.size();
    double length = 0.0;
    for (auto i = static_cast<std::size_t>(from); i != static_cast<std::size_t>(to);
         i = (i + 1) % n) {
        length += region.distance(region.border[i], region.border[(i + 1) % n]);
    }
    return length;
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
        patch.area = 0.5 * doubled_area_vector(region, t).norm();
        result.push_back(patch);
    }
    return result;
}

/// The flat direction along which the position along `axis` grows.
Vec2 direction_of(const Vec3& axis, const std::vector<Patch>& pieces) {
    double area = 0.0, mean_along = 0.0;
    Vec2 mean_flat = Vec2::Zero();
    for (const Patch& p : pieces) {
        area += p.area;
        mean_along += p.area * p.centre.dot(axis);
        mean_flat += p.area * p.flat_centre;
    }
    mean_along /= area;
    mean_flat /= area;
    Vec2 direction = Vec2::Zero();
    for (const Patch& p : pieces) {
        direction += p.area * (p.centre.dot(axis) - mean_along) * (p.flat_centre - mean_flat);
    }
    return direction;
}

Vec2 centroid_of(const Region& region, const Points2& uv) {
    double area = 0.0;
    Vec2 moment = Vec2::Zero();
    for (const Triangle& t : region.triangles) {
        const Vec2 &a = uv[at(t[0])], &b = uv[at(t[1])], &c = uv[at(t[2])];
        const double doubled = cross(Vec2(b - a), Vec2(c - a));
        area += doubled;
        moment += doubled / 3.0 * (a + b + c);
    }
    return area > 0.0 ? Vec2(moment / area) : uv.front();
}

}  // namespace

/// Heel and centre front leave two stretches of border: the featherline's is the longer one.
std::optional<BaseLine> named_base_line(const Region& region) {
    const auto segments = border_segments(region, region.border);
    const BorderSegment* heel = segment_of(segments, curve_name::heel);
    const auto front = front_segment(segments);
    if (heel == nullptr || !front) return std::nullopt;
    const auto vertex = [&](Index i) { return region.border[static_cast<std::size_t>(i)]; };
    if (border_length(region, heel->last, front->first) >
        border_length(region, front->last, heel->first)) {
        return BaseLine{vertex(heel->last), vertex(front->first)};
    }
    return BaseLine{vertex(heel->first), vertex(front->last)};
}

Vec3 long_axis(const std::vector<Region>& regions) {
    double area = 0.0;
    Vec3 mean = Vec3::Zero();
    const auto for_triangles = [&](auto visit) {
        for (const Region& region : regions) {
            for (const Triangle& t : region.triangles)
                visit(centroid(region, t), 0.5 * doubled_area_vector(region, t).norm());
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
    for_triangles(
        [&](const Vec3& centre, double a) { skew += a * std::pow((centre - mean).dot(axis), 3); });
    return skew < 0.0 ? Vec3(-axis) : axis;
}

void orient_charts(const std::vector<Region>& regions, const std::vector<Constraint>& constraints,
                   std::vector<Chart>& charts) {
    const Vec3 axis = long_axis(regions);
    for (std::size_t r = 0; r < regions.size(); ++r) {
        Points2& uv = charts[r].uv;
        const auto pins = pinned_vertices(regions[r], constraints);
        if (pins.size() > 1) {
            move_to_pins(pins, uv);
            continue;
        }
        const auto line = named_base_line(regions[r]);
        const Vec2 base = line ? Vec2(uv[at(line->toe)] - uv[at(line->seat)])
                               : direction_of(axis, patches(regions[r], charts[r]));
        const double length = base.norm();
        const Vec2 along = length > 0.0 ? Vec2(base / length) : Vec2::UnitX();
        for (Vec2& p : uv) p = {along.dot(p), cross(along, p)};
        const Vec2 origin = !pins.empty() ? Vec2(uv[at(pins.front().vertex)] - pins.front().at)
                            : line        ? uv[at(line->seat)]
                                          : centroid_of(regions[r], uv);
        for (Vec2& p : uv) p -= origin;
    }
}

}  // namespace lastflat
