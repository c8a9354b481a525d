#include "core/parameterize/start.h"

#include <Eigen/Geometry>

#include "core/border/convex_border.h"
#include "core/parameterize/fill_holes.h"
#include "core/parameterize/fixed_border.h"
#include "core/parameterize/floating_border.h"

namespace lastflat {
namespace {

Chart floating_chart(const Region& region, const std::vector<bool>& locked, WeightRule weights,
                     AngleRule angles) {
    const Dissection dissection = dissection_of(region.positions, region.half_edges);
    return flatten_floating_border(region, dissection, weights,
                                   border_polygon(region, dissection, locked, angles));
}

/// Why a chart cannot be the start of an energy; empty: it can.
std::string fault_of(const Region& region, const Chart& chart) {
    const auto flipped = flipped_triangles(region, chart.uv);
    if (!flipped.empty()) return std::to_string(flipped.size()) + " triangles of it are flipped";
    return border_crossings(region, chart.uv).empty() ? "" : "its border crosses itself";
}

/// The region seen along its mean normal: of a flat one, itself.
Chart shadow(const Region& region) {
    const Vec3 normal = area_vector(region);
    Chart chart;
    if (!(normal.norm() > 0.0)) return chart;
    const Vec3 across = normal.unitOrthogonal(), along = across.cross(normal.normalized());
    for (const Vec3& p : region.positions) chart.uv.emplace_back(along.dot(p), across.dot(p));
    return chart;
}

/// Without the points that only the disk has.
Chart part_of(Chart disk, const Region& region) {
    disk.uv.resize(region.positions.size());
    return disk;
}

/// Why the geodesic fan cannot be the start, or nothing and the chart.
std::string try_fan(const Region& region, const Region& disk, const std::vector<bool>& locked,
                    AngleRule angles, Chart& chart) {
    try {
        chart = part_of(floating_chart(disk, locked, mean_value_weights, angles), region);
    } catch (const Error& error) {
        return error.what();
    }
    return fault_of(region, chart);
}

Start energy_start(const Region& region, const Region& disk, const std::vector<bool>& locked,
                   AngleRule angles) {
    Start start;
    const std::string why = try_fan(region, disk, locked, angles, start.chart);
    if (why.empty()) return start;
    Chart flat = shadow(region);
    if (!flat.uv.empty() && fault_of(region, flat).empty()) {
        start.chart = std::move(flat);
        start.warnings.push_back({"start_replaced",
                                  "region '" + region.name +
                                      "' starts from its shadow on a plane, not from the geodesic "
                                      "fan: " +
                                      why,
                                  std::nullopt});
        return start;
    }
    start.chart =
        part_of(flatten_fixed_border(disk, mean_value_weights, circle_border(disk)), region);
    const auto flipped = flipped_triangles(region, start.chart.uv);
    if (!flipped.empty()) {
        const Vec3& where =
            region.position(region.triangles[static_cast<std::size_t>(flipped.front())][0]);
        throw Error(ErrorCode::method_failed,
                    "region '" + region.name + "' has no start without folds: the geodesic fan (" +
                        why + ") and mean values on a circle (" + std::to_string(flipped.size()) +
                        " triangles collapse, the first at " + position_text(where) +
                        "); cut the region so that it opens wider")
            .at_position(where)
            .at_triangles(source_triangles(region, flipped));
    }
    start.warnings.push_back({"start_replaced",
                              "region '" + region.name +
                                  "' starts from a circle, not from the "
                                  "geodesic fan: " +
                                  why,
                              std::nullopt});
    return start;
}

/// The two that have negative weights on obtuse or concave stars: how many, and where first.
void warn_of_negative_weights(const Region& region, WeightRule rule,
                              std::vector<Warning>& warnings) {
    std::size_t count = 0;
    std::optional<Vec3> where;
    for (Index v = 0; v < static_cast<Index>(region.positions.size()); ++v) {
        if (region.half_edges.on_border(v)) continue;
        for (const double weight : rule(surface_star(region, v))) {
            if (weight >= 0.0) continue;
            ++count;
            if (!where) where = region.position(v);
        }
    }
    if (count > 0) {
        warnings.push_back({"negative_weights",
                            "region '" + region.name + "': " + std::to_string(count) +
                                " weights are negative, the first at " + position_text(*where) +
                                "; the map need not be free of folds",
                            where});
    }
}

WeightRule weight_rule(MethodName name) {
    switch (name) {
        case MethodName::tutte: return tutte_weights;
        case MethodName::chord_length: return chord_length_weights;
        case MethodName::virtual_border:
        case MethodName::shape_preserving: return shape_preserving_weights;
        case MethodName::harmonic: return harmonic_weights;
        case MethodName::wachspress: return wachspress_weights;
        case MethodName::mean_value:
        case MethodName::geodesic_fan:
        case MethodName::mips:
        case MethodName::green_lagrange:
        case MethodName::isometric: return mean_value_weights;
    }
    return mean_value_weights;
}

Points2 convex_border(const Region& region, const std::vector<bool>& locked, BorderShape shape,
                      AngleRule angles) {
    switch (shape) {
        case BorderShape::square: return bulged_under_chords(region, square_border(region));
        case BorderShape::hull: {
            return bulged_under_chords(
                region, hull_border(border_polygon(
                                        region, dissection_of(region.positions, region.half_edges),
                                        locked, angles)
                                        .points));
        }
        case BorderShape::circle:
        case BorderShape::floating: break;
    }
    return circle_border(region);
}

}  // namespace

Start start_chart(const Region& region, const std::vector<bool>& locked_border,
                  const MethodOptions& method) {
    const Region disk = with_holes_filled(region);
    if (is_energy(method.name)) return energy_start(region, disk, locked_border, method.angles);
    const WeightRule rule = weight_rule(method.name);
    Start start;
    if (rule == harmonic_weights || rule == wachspress_weights) {
        warn_of_negative_weights(region, rule, start.warnings);
    }
    const bool floats = method.border == BorderShape::floating ||
                        method.name == MethodName::virtual_border ||
                        method.name == MethodName::geodesic_fan;
    start.chart = part_of(
        floats ? floating_chart(disk, locked_border, rule, method.angles)
               : flatten_fixed_border(
                     disk, rule, convex_border(disk, locked_border, method.border, method.angles)),
        region);
    return start;
}

}  // namespace lastflat
