#include "core/constrain/distortion_weights.h"

#include <algorithm>
#include <unordered_set>

#include "core/numerics/box_tree.h"
#include "core/numerics/geometry.h"

namespace lastflat {
namespace {

constexpr double least_weight = 1e-3, most_weight = 1e3;

/// What lies within a distance of a curve's runs.
class NearCurve {
public:
    NearCurve(const Region& region, const Zone& zone)
        : segments_(segments_of(region, zone.curve)), tree_(boxes_of(segments_)), zone_(zone) {}

    [[nodiscard]] bool operator()(const Vec3& p) const {
        Box3 box(p, p);
        box.min().array() -= zone_.within_mm;
        box.max().array() += zone_.within_mm;
        return tree_.find(box, [&](Index i) {
            const auto& [a, b] = segments_[static_cast<std::size_t>(i)];
            return distance_to_segment(p, a, b) <= zone_.within_mm;
        });
    }

private:
    using Segment = std::pair<Vec3, Vec3>;

    static std::vector<Segment> segments_of(const Region& region, const std::string& curve) {
        std::vector<Segment> segments;
        for (const CurveRun& run : region.runs) {
            if (run.curve != curve) continue;
            for (std::size_t i = 1; i < run.vertices.size(); ++i) {
                segments.emplace_back(region.position(run.vertices[i - 1]),
                                      region.position(run.vertices[i]));
            }
        }
        return segments;
    }

    static std::vector<Box3> boxes_of(const std::vector<Segment>& segments) {
        std::vector<Box3> boxes;
        for (const auto& [a, b] : segments) {
            boxes.emplace_back(a, a);
            boxes.back().extend(b);
        }
        return boxes;
    }

    std::vector<Segment> segments_;
    BoxTree<Box3> tree_;
    const Zone& zone_;
};

/// Vertices that a vertex of the file has become in this region.
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
        const std::unordered_set<Index> listed(zone.vertices.begin(), zone.vertices.end());
        std::vector<bool> is_listed;
        for (const Index source : region.source_vertices)
            is_listed.push_back(listed.count(source) > 0);
        const auto centres = positions_of(region, zone.vertex);
        const NearCurve is_near_curve(region, zone);
        const auto is_in = [&](const Triangle& t) {
            if (!listed.empty()) {
                return std::all_of(t.begin(), t.end(),
                                   [&](Index v) { return is_listed[static_cast<std::size_t>(v)]; });
            }
            const Vec3 middle =
                (region.position(t[0]) + region.position(t[1]) + region.position(t[2])) / 3.0;
            if (zone.curve.empty()) {
                return std::any_of(centres.begin(), centres.end(), [&](const Vec3& centre) {
                    return (middle - centre).norm() <= zone.within_mm;
                });
            }
            return is_near_curve(middle);
        };
        for (std::size_t t = 0; t < weights.size(); ++t) {
            if (is_in(region.triangles[t]))
                weights[t] = std::clamp(weights[t] * zone.weight, least_weight, most_weight);
        }
    }
    return weights;
}

}  // namespace lastflat
