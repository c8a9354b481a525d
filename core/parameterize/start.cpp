#include "core/parameterize/start.h"

#include "core/border/convex_border.h"
#include "core/parameterize/geodesic_fan.h"
#include "core/parameterize/mean_value.h"

namespace lastflat {
namespace {

/// Why the geodesic fan cannot be the start, or nothing and the chart.
std::string try_fan(const Region& region, const std::vector<bool>& locked, AngleRule angles,
                    Chart& chart) {
    try {
        chart = flatten_geodesic_fan(region, locked, angles);
    } catch (const Error& error) {
        return error.what();
    }
    const auto flipped = flipped_triangles(region, chart.uv);
    if (flipped.empty()) return {};
    return std::to_string(flipped.size()) + " triangles of it are flipped";
}

Start isometric_start(const Region& region, const std::vector<bool>& locked, AngleRule angles) {
    Start start;
    const std::string why = try_fan(region, locked, angles, start.chart);
    if (why.empty()) return start;
    start.chart = flatten_mean_value(region, circle_border(region));
    const auto flipped = flipped_triangles(region, start.chart.uv);
    if (!flipped.empty()) {
        const Vec3& where =
            region.position(region.triangles[static_cast<std::size_t>(flipped.front())][0]);
        throw Error(ErrorCode::method_failed,
                    "region '" + region.name + "' has no start without folds: the geodesic fan (" +
                        why + ") and mean values on a circle (" + std::to_string(flipped.size()) +
                        " triangles collapse, the first at " + place(where) +
                        "); cut the region so that it opens wider")
            .at_position(where);
    }
    start.warnings.push_back({"start_replaced",
                              "region '" + region.name +
                                  "' starts from a circle, not from the "
                                  "geodesic fan: " +
                                  why,
                              std::nullopt});
    return start;
}

}  // namespace

Start start_chart(const Region& region, const std::vector<bool>& locked_border,
                  const MethodOptions& method) {
    switch (method.name) {
        case MethodName::mean_value:
            return {flatten_mean_value(region, method.border == BorderShape::circle
                                                   ? circle_border(region)
                                                   : square_border(region)),
                    {}};
        case MethodName::geodesic_fan:
            return {flatten_geodesic_fan(region, locked_border, method.angles), {}};
        case MethodName::isometric: return isometric_start(region, locked_border, method.angles);
    }
    return {};
}

}  // namespace lastflat
