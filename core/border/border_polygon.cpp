// Based on: Kim, Kim, "Geodesic-Fan Based Mesh Parameterization in Shoe CAD System".
#include "core/border/border_polygon.h"

#include "core/border/tweak_edges.h"
#include "core/error.h"

namespace lastflat {
namespace {

/// "curve 'heel', at 1.0 2.0 3.0": the first named curve along border edge i, and where it lies.
std::string border_edge_name(const Region& region, std::size_t i) {
    const Index a = region.border[i], b = region.border[(i + 1) % region.border.size()];
    const std::string where = "at " + position_text(region.position(a));
    for (const CurveRun& run : region.runs) {
        for (std::size_t k = 1; k < run.vertices.size(); ++k) {
            const Index p = run.vertices[k - 1], q = run.vertices[k];
            if ((p == a && q == b) || (p == b && q == a))
                return "curve '" + run.curve + "', " + where;
        }
    }
    return "the border " + where;
}

}  // namespace

BorderPolygon border_polygon(const Region& region, const Dissection& dissection,
                             const std::vector<bool>& locked, AngleRule rule) {
    BorderPolygon polygon;
    polygon.angles = border_angles(region, dissection, rule);
    polygon.points = tweak_edges(border_lengths(region), polygon.angles.turning, locked,
                                 [&](std::size_t edge) { return border_edge_name(region, edge); });
    return polygon;
}

}  // namespace lastflat
