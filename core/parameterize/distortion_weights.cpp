#include "core/parameterize/distortion_weights.h"

#include <algorithm>
#include <limits>
#include <set>

namespace lastflat {
namespace {

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 along = b - a;
    const double length = along.squaredNorm();
    const double t = length > 0.0 ? std::clamp((p - a).dot(along) / length, 0.0, 1.0) : 0.0;
    return (p - a - t * along).norm();
}

double distance_to_curve(const Region& region, const std::string& curve, const Vec3& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const CurveRun& run : region.runs) {
        if (run.curve != curve) continue;
        for (std::size_t i = 1; i < run.vertices.size(); ++i) {
            least = std::min(least, distance_to_segment(p, region.position(run.vertices[i - 1]),
                                                        region.position(run.vertices[i])));
        }
    }
    return least;
}

/// Places of a vertex of the file in this region.
std::vector<Vec3> positions_of(const Region& region, Index source) {
    std::vector<Vec3> positions;
    for (std::size_t v = 0; v < region.source_vertices.size(); ++v) {
        if (region.source_vertices[v] == source) positions.push_back(region.positions[v]);
    }
    return positions;
}

}  // namespace

std::vector<double> triangle_weights(const Region& region, const std::vector<Zone>& zones) {
    std::vector<double> weights(region.triangles.size(), 1.0);
    for (const Zone& zone : zones) {
        const std::set<Index> listed(zone.vertices.begin(), zone.vertices.end());
        const auto centres = positions_of(region, zone.vertex);
        const auto is_in = [&](const Triangle& t) {
            if (!listed.empty()) {
                return std::all_of(t.begin(), t.end(), [&](Index v) {
                    return listed.count(region.source_vertices[static_cast<std::size_t>(v)]) > 0;
                });
            }
            const Vec3 middle =
                (region.position(t[0]) + region.position(t[1]) + region.position(t[2])) / 3.0;
            if (zone.curve.empty()) {
                return std::any_of(centres.begin(), centres.end(), [&](const Vec3& centre) {
                    return (middle - centre).norm() <= zone.within_mm;
                });
            }
            return distance_to_curve(region, zone.curve, middle) <= zone.within_mm;
        };
        for (std::size_t t = 0; t < weights.size(); ++t) {
            if (is_in(region.triangles[t])) weights[t] *= zone.weight;
        }
    }
    return weights;
}

}  // namespace lastflat
