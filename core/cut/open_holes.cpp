#include "core/cut/open_holes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>
#include <numbers>

#include "core/cut/edge_paths.h"
#include "core/geodesic/trace_path.h"
#include "core/numerics/disjoint_sets.h"

namespace lastflat {
namespace {

constexpr double most_kept_curvature = std::numbers::pi / 2;

/// A piece is long if its border reaches this many times as far along as across, and its hole near
/// an end if it is off the middle by this share of the length.
constexpr double long_from = 1.5, off_middle = 0.05;

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
    const Eigen::Vector3d& squares = eigen.eigenvalues();
    if (squares[2] < long_from * long_from * squares[1]) return std::nullopt;
    Vec3 axis = eigen.eigenvectors().col(2);
    const double off = axis.dot(centre_of(region, hole) - centre);
    if (off < 0.0) axis = -axis;
    const auto along = [&](Index v) { return axis.dot(region.position(v) - centre); };
    const auto by_position = [&](Index a, Index b) { return along(a) < along(b); };
    const auto [front, rear] =
        std::minmax_element(region.border.begin(), region.border.end(), by_position);
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
          joined_(loops_.size()) {
        for (std::size_t k = 0; k < loops_.size(); ++k) {
            for (const Index v : loops_[k])
                loop_of_[static_cast<std::size_t>(v)] = static_cast<Index>(k);
        }
    }

    /// `hole`: its index among the border loops; `at_end`: where a last has its heel.
    std::vector<HoleSeam> run(std::size_t hole, double curvature, bool at_end) {
        hole_ = hole;
        curvature_ = curvature;
        if (at_end && along_heel()) return std::move(seams_);
        const auto rear = at_end ? rear_vertex(region_, loops_[hole]) : std::nullopt;
        open(shortest(rear ? std::vector{*rear} : loops_[0]));
        return std::move(seams_);
    }

private:
    bool along_heel() {
        for (const CurveRun& run : region_.runs) {
            const Index from = run.vertices.front(), to = run.vertices.back();
            const bool fits = (on_hole(from) && on_outer(to)) || (on_hole(to) && on_outer(from));
            if (run.curve != curve_name::heel || !fits || !join(from, to)) continue;
            double length = 0.0;
            for (std::size_t i = 1; i < run.vertices.size(); ++i)
                length += region_.distance(run.vertices[i - 1], run.vertices[i]);
            seams_.push_back({curve_name::heel,
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
        return loop_of_[static_cast<std::size_t>(v)] == 0;
    }
    [[nodiscard]] bool on_hole(Index v) const {
        return loop_of_[static_cast<std::size_t>(v)] == static_cast<Index>(hole_);
    }

    /// From any of these vertices to the hole: along edges first, then straight across the faces
    /// around that way. Where straight paths cannot be found (`ExactGeodesics`) the edges are it.
    [[nodiscard]] GeodesicPath shortest(const std::vector<Index>& from) const {
        const EdgePaths paths(region_, from);
        const Index end = paths.nearest([&](Index v) { return on_hole(v); });
        const std::vector<Index> edges = paths.to(end);
        constexpr double room = 1.5;
        const EdgePaths near(region_, {edges.front()}, room * paths.distance(end));
        try {
            return straightened(near, edges);
        } catch (const Error& error) {
            if (error.code() != ErrorCode::solver_failed) throw;
        }
        GeodesicPath path;
        for (const Index v : edges) path.points.push_back({v, v, 0.0});
        return path;
    }

    /// The shortest path from the first vertex to the hole on the triangles around what `near` has
    /// reached.
    [[nodiscard]] GeodesicPath straightened(const EdgePaths& near,
                                            const std::vector<Index>& edges) const {
        Triangulation part;
        std::vector<Index> index(region_.positions.size(), -1), source;
        for (const Triangle& t : region_.triangles) {
            if (std::none_of(t.begin(), t.end(), [&](Index v) { return near.reaches(v); }))
                continue;
            Triangle renamed{};
            for (std::size_t i = 0; i < 3; ++i) {
                Index& v = index[static_cast<std::size_t>(t[i])];
                if (v < 0) {
                    v = static_cast<Index>(source.size());
                    source.push_back(t[i]);
                    part.positions.push_back(region_.position(t[i]));
                }
                renamed[i] = v;
            }
            part.triangles.push_back(renamed);
        }
        const ExactGeodesics geodesics(part);
        const auto distances =
            geodesics.from_vertex(index[static_cast<std::size_t>(edges.front())], progress_);
        Index end = index[static_cast<std::size_t>(edges.back())];
        for (Index v = 0; v < static_cast<Index>(source.size()); ++v) {
            if (on_hole(source[static_cast<std::size_t>(v)]) &&
                distances.distance[static_cast<std::size_t>(v)] <
                    distances.distance[static_cast<std::size_t>(end)])
                end = v;
        }
        GeodesicPath path = trace_path(geodesics.unfolding(), distances, end);
        for (PathPoint& point : path.points) {
            point.a = source[static_cast<std::size_t>(point.a)];
            point.b = source[static_cast<std::size_t>(point.b)];
        }
        return path;
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
            seam.points.push_back(p.a == p.b ? SurfacePoint::at_vertex(a)
                                             : SurfacePoint::on_edge(a, b, p.share));
            if (i > begin)
                seam.length += (position_of(p, region_.positions) -
                                position_of(path.points[i - 1], region_.positions))
                                   .norm();
        }
        seam.position = position_of(path.points[(begin + end) / 2], region_.positions);
        seam.curvature = curvature_;
        seams_.push_back(std::move(seam));
    }

    const Region& region_;
    const Progress& progress_;
    const std::vector<std::vector<Index>> loops_;
    std::vector<Index> loop_of_;  ///< per vertex; -1: inside
    DisjointSets joined_;
    std::size_t hole_ = 0;
    double curvature_ = 0.0;
    std::vector<HoleSeam> seams_;
};

}  // namespace

std::vector<double> hole_curvatures(const Region& region) {
    std::vector<double> curvatures = loop_turnings(region, region.holes);
    for (double& curvature : curvatures) curvature += 2.0 * std::numbers::pi;
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
    const auto is_much = [](double curvature) { return std::abs(curvature) > most_kept_curvature; };
    std::size_t longest = 0;  // its index among the border loops; 0: none
    for (std::size_t k = 0; k < region.holes.size(); ++k) {
        const auto& hole = region.holes[k];
        if (is_slit(region, hole) || !(is_much(curvatures[k]) || rule == HoleRule::open)) continue;
        if (longest == 0 ||
            loop_length(region, hole) > loop_length(region, region.holes[longest - 1]))
            longest = k + 1;
    }
    if (longest == 0) return {};
    const double curvature = curvatures[longest - 1];
    return Opener(region, progress).run(longest, curvature, is_first && is_much(curvature));
}

}  // namespace lastflat
