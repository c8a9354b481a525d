#include "core/cut/open_holes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>

#include "core/geodesic/trace_path.h"
#include "core/numerics/disjoint_sets.h"
#include "core/numerics/polygon.h"

namespace lastflat {
namespace {

constexpr double most_kept_curvature = std::numbers::pi / 2;

/// A piece is long if its border reaches this many times as far along as across, and its hole near
/// an end if it is off the middle by this share of the length.
constexpr double long_from = 1.5, off_middle = 0.05;

/// From so many vertices of a hole the shortest way is sought.
constexpr std::size_t most_starts = 4;

constexpr const char* heel = "heel";

double length_of(const Region& region, const std::vector<Index>& loop) {
    const auto lengths = loop_lengths(region, loop);
    return std::accumulate(lengths.begin(), lengths.end(), 0.0);
}

/// The centre of a loop, every part by its length.
Vec3 centre_of(const Region& region, const std::vector<Index>& loop) {
    const auto lengths = loop_lengths(region, loop);
    Vec3 sum = Vec3::Zero();
    double total = 0.0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec3& next = region.position(loop[(i + 1) % loop.size()]);
        sum += 0.5 * lengths[i] * (region.position(loop[i]) + next);
        total += lengths[i];
    }
    return sum / total;
}

/// The vertex of the outer loop that lies furthest at the hole's end, if both have such ends.
std::optional<Index> rear_vertex(const Region& region, const std::vector<Index>& hole) {
    const Vec3 centre = centre_of(region, region.border);
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Index v : region.border) {
        const Vec3 d = region.position(v) - centre;
        spread += d * d.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread);
    const Eigen::Vector3d squares = eigen.eigenvalues();
    if (squares[2] < long_from * long_from * squares[1]) return std::nullopt;
    Vec3 axis = eigen.eigenvectors().col(2);
    const double off = axis.dot(centre_of(region, hole) - centre);
    if (off < 0.0) axis = -axis;
    const auto along = [&](Index v) { return axis.dot(region.position(v) - centre); };
    const auto by_place = [&](Index a, Index b) { return along(a) < along(b); };
    const auto [front, rear] =
        std::minmax_element(region.border.begin(), region.border.end(), by_place);
    if (std::abs(off) < off_middle * (along(*rear) - along(*front))) return std::nullopt;
    return *rear;
}

class Opener {
public:
    Opener(const Region& region, const Progress& progress)
        : region_(region),
          progress_(progress),
          loops_(border_loops(region)),
          loop_of_(region.positions.size(), -1),
          joined_(loops_.size()),
          geodesics_(region) {
        for (std::size_t k = 0; k < loops_.size(); ++k) {
            for (const Index v : loops_[k])
                loop_of_[static_cast<std::size_t>(v)] = static_cast<Index>(k);
        }
    }

    /// `hole`: its place among the border loops.
    std::vector<HoleSeam> run(std::size_t hole, double curvature, bool is_first) {
        hole_ = hole;
        curvature_ = curvature;
        if (is_first && along_heel()) return std::move(seams_);
        const auto rear = is_first ? rear_vertex(region_, loops_[hole]) : std::nullopt;
        open(rear ? from(*rear) : shortest());
        return std::move(seams_);
    }

private:
    bool along_heel() {
        for (const CurveRun& run : region_.runs) {
            if (run.curve != heel || !join(run.vertices.front(), run.vertices.back())) continue;
            double length = 0.0;
            for (std::size_t i = 1; i < run.vertices.size(); ++i)
                length += region_.distance(run.vertices[i - 1], run.vertices[i]);
            seams_.push_back({heel,
                              {},
                              length,
                              region_.position(run.vertices[run.vertices.size() / 2]),
                              curvature_});
            return true;
        }
        return false;
    }

    /// Whether both are on loops that were apart before.
    bool join(Index a, Index b) {
        const Index one = loop_of_[static_cast<std::size_t>(a)];
        const Index other = loop_of_[static_cast<std::size_t>(b)];
        if (one < 0 || other < 0 || joined_.find(one) == joined_.find(other)) return false;
        joined_.join(one, other);
        return true;
    }

    [[nodiscard]] bool on_outer(Index v) const {
        const Index loop = loop_of_[static_cast<std::size_t>(v)];
        return loop >= 0 && joined_.find(loop) == joined_.find(0);
    }
    [[nodiscard]] bool on_hole(Index v) const {
        return loop_of_[static_cast<std::size_t>(v)] == static_cast<Index>(hole_);
    }

    template <class Choice>
    [[nodiscard]] Index nearest(const GeodesicDistances& distances, const Choice& choice) const {
        Index best = -1;
        for (Index v = 0; v < static_cast<Index>(region_.positions.size()); ++v) {
            if (!choice(v)) continue;
            if (best < 0 || distances.distance[static_cast<std::size_t>(v)] <
                                distances.distance[static_cast<std::size_t>(best)])
                best = v;
        }
        return best;
    }

    [[nodiscard]] GeodesicPath from(Index start) const {
        const auto distances = geodesics_.from_vertex(start, progress_);
        return trace_path(geodesics_.half_edges(), distances,
                          nearest(distances, [&](Index v) { return on_hole(v); }));
    }

    /// The best of a few ways out of the hole, then to and fro between the loops until it gets no
    /// shorter.
    [[nodiscard]] GeodesicPath shortest() const {
        const auto out = [&](Index v) { return on_outer(v); };
        const auto& hole = loops_[hole_];
        const std::size_t starts = std::min(most_starts, hole.size());
        GeodesicDistances distances;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < starts; ++k) {
            auto tried = geodesics_.from_vertex(hole[k * hole.size() / starts], progress_);
            const double distance = tried.distance[static_cast<std::size_t>(nearest(tried, out))];
            if (distance >= least) continue;
            least = distance;
            distances = std::move(tried);
        }
        least = std::numeric_limits<double>::infinity();
        for (bool from_hole = true;; from_hole = !from_hole) {
            const Index end =
                nearest(distances, [&](Index v) { return from_hole ? on_outer(v) : on_hole(v); });
            const double distance = distances.distance[static_cast<std::size_t>(end)];
            if (!(distance < least)) return trace_path(geodesics_.half_edges(), distances, end);
            least = distance;
            distances = geodesics_.from_vertex(end, progress_);
        }
    }

    /// A path may touch other loops on its way: only its parts that join what was apart are cut.
    void open(const GeodesicPath& path) {
        std::size_t begin = 0;
        for (std::size_t i = 1; i < path.points.size(); ++i) {
            const PathPoint& point = path.points[i];
            if (point.a != point.b || loop_of_[static_cast<std::size_t>(point.a)] < 0) continue;
            if (join(path.points[begin].a, point.a)) add(path, begin, i);
            begin = i;
        }
    }

    void add(const GeodesicPath& path, std::size_t begin, std::size_t end) {
        HoleSeam seam;
        for (std::size_t i = begin; i <= end; ++i) {
            const PathPoint& p = path.points[i];
            const Index a = region_.source_vertices[static_cast<std::size_t>(p.a)];
            const Index b = region_.source_vertices[static_cast<std::size_t>(p.b)];
            seam.places.push_back(p.a == p.b ? SurfacePlace::at_vertex(a)
                                             : SurfacePlace::on_edge(a, b, p.share));
            if (i > begin)
                seam.length += (place_of(p, region_.positions) -
                                place_of(path.points[i - 1], region_.positions))
                                   .norm();
        }
        seam.position = place_of(path.points[(begin + end) / 2], region_.positions);
        seam.curvature = curvature_;
        seams_.push_back(std::move(seam));
    }

    const Region& region_;
    const Progress& progress_;
    const std::vector<std::vector<Index>> loops_;
    std::vector<Index> loop_of_;  ///< per vertex; -1: inside
    mutable DisjointSets joined_;
    const ExactGeodesics geodesics_;
    std::size_t hole_ = 0;
    double curvature_ = 0.0;
    std::vector<HoleSeam> seams_;
};

}  // namespace

std::vector<double> hole_curvatures(const Region& region) {
    const auto on_border = border_mask(region);
    std::vector<double> angles(region.positions.size(), 0.0);
    for (const Triangle& t : region.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto v = static_cast<std::size_t>(t[i]);
            if (on_border[v])
                angles[v] += angle_at(region.position(t[i]), region.position(t[(i + 1) % 3]),
                                      region.position(t[(i + 2) % 3]));
        }
    }
    std::vector<double> curvatures;
    for (const auto& hole : region.holes) {
        double turning = 0.0;
        for (const Index v : hole)
            turning += std::numbers::pi - angles[static_cast<std::size_t>(v)];
        curvatures.push_back(2.0 * std::numbers::pi + turning);
    }
    return curvatures;
}

bool is_slit(const Region& region, const std::vector<Index>& loop) {
    std::map<std::pair<Index, Index>, int> sides;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const auto source = [&](std::size_t k) {
            return region.source_vertices[static_cast<std::size_t>(loop[k % loop.size()])];
        };
        ++sides[std::minmax({source(i), source(i + 1)})];
    }
    return std::all_of(sides.begin(), sides.end(), [](const auto& s) { return s.second == 2; });
}

std::vector<HoleSeam> seams_of_next_hole(const Region& region, HoleRule rule, bool is_first,
                                         const Progress& progress) {
    if (rule == HoleRule::keep) return {};
    const auto curvatures = hole_curvatures(region);
    std::size_t longest = 0;  // its place among the border loops; 0: none
    for (std::size_t k = 0; k < region.holes.size(); ++k) {
        const auto& hole = region.holes[k];
        const bool much = std::abs(curvatures[k]) > most_kept_curvature;
        if (is_slit(region, hole) || !(much || rule == HoleRule::open)) continue;
        if (longest == 0 || length_of(region, hole) > length_of(region, region.holes[longest - 1]))
            longest = k + 1;
    }
    if (longest == 0) return {};
    return Opener(region, progress).run(longest, curvatures[longest - 1], is_first);
}

}  // namespace lastflat
