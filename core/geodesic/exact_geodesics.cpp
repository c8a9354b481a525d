// Based on: Chen, Han, "Shortest Paths on a Polyhedron", SoCG 1990; Xin, Wang, "Improving Chen and
// Han's Algorithm on the Discrete Geodesic Problem", TOG 2009; Xu, Wang, Liu, Liu, He, "Fast
// Wavefront Propagation for Computing Exact Geodesic Distances on Meshes", TVCG 2015.
#include "core/geodesic/exact_geodesics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/numerics/geometry.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

using std::numbers::pi;

/// Light from a root that falls through a stretch of an edge into the triangle of `half_edge`.
struct Window {
    double begin, end;  ///< the stretch, as x in the half-edge's frame
    Vec2 position;      ///< of the root in that frame, y <= 0
    double offset;      ///< from the source to the root
    Index half_edge;    ///< spawn: no light yet, the root is to be opened
    Index root;
    static constexpr Index spawn = -1;

    [[nodiscard]] double distance_at(double x) const {
        return offset +
               std::sqrt((x - position.x()) * (x - position.x()) + position.y() * position.y());
    }
    [[nodiscard]] double least_distance() const {
        return distance_at(std::clamp(position.x(), begin, end));
    }
};

/// A queue that is sorted only by classes of distance: exact order is not needed, for windows of
/// later classes never improve what earlier ones have found by much.
class Buckets {
public:
    Buckets(double width, std::size_t most_buckets, std::size_t most_windows)
        : width_(width), last_(most_buckets), left_(most_windows) {}

    void push(const Window& window, double distance) {
        constexpr std::size_t most_held = 16'000'000;  // 768 MB
        if (left_-- == 0 || ++held_ > most_held) {
            throw Error(ErrorCode::solver_failed,
                        "the shortest paths on this surface are too many to follow");
        }
        const double wanted = std::min(distance / width_, static_cast<double>(last_));
        const auto bucket = std::max(current_, static_cast<std::size_t>(wanted));
        if (bucket >= buckets_.size()) buckets_.resize(bucket + 1);
        buckets_[bucket].push_back(window);
    }
    /// Takes the oldest window of the nearest class. False: none is left.
    bool pop(Window& window) {
        while (current_ < buckets_.size()) {
            auto& bucket = buckets_[current_];
            if (next_ < bucket.size()) {
                window = bucket[next_++];
                return true;
            }
            held_ -= bucket.size();
            std::vector<Window>().swap(bucket);
            next_ = 0;
            ++current_;
        }
        return false;
    }

private:
    double width_;
    std::vector<std::vector<Window>> buckets_;
    std::size_t current_ = 0, next_ = 0, held_ = 0;
    std::size_t last_;  ///< bucket, which takes all that is further
    std::size_t left_;  ///< how many more windows may come
};

class Propagation {
public:
    Propagation(const Unfolding& unfolding, const std::vector<double>& total_angles,
                std::size_t most_windows)
        : half_edges_(unfolding),
          total_angles_(total_angles),
          splits_(at(unfolding.count())),
          buckets_(0.3 * median_length(unfolding), 4 * at(unfolding.count()), most_windows) {
        result_.distance.assign(total_angles.size(), infinity);
        result_.arrivals.assign(total_angles.size(), {-1, -1, {0, 0}});
    }

    GeodesicDistances run(Index vertex, const Progress& progress) {
        result_.source = vertex;
        result_.distance[at(vertex)] = 0.0;
        result_.arrivals[at(vertex)].root = vertex;
        open(vertex);
        propagate_all(progress);
        return std::move(result_);
    }

private:
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    static double median_length(const Unfolding& unfolding) {
        std::vector<double> lengths;
        lengths.reserve(at(unfolding.count()));
        for (Index h = 0; h < unfolding.count(); ++h) lengths.push_back(unfolding.length(h));
        const auto middle = lengths.begin() + unfolding.count() / 2;
        std::nth_element(lengths.begin(), middle, lengths.end());
        return *middle;
    }

    void propagate_all(const Progress& progress) {
        constexpr std::size_t check_every = 4096;
        Window window{};
        for (std::size_t count = 1; buckets_.pop(window); ++count) {
            if (count % check_every == 0) progress.check();
            if (window.half_edge != Window::spawn) {
                propagate(window);
            } else if (window.offset <= result_.distance[at(window.root)]) {
                open(window.root);
            }
        }
        for (Index v = 0; v < half_edges_.vertex_count(); ++v) {
            if (half_edges_.outgoing(v) < 0 || std::isfinite(result_.distance[at(v)])) continue;
            throw Error(ErrorCode::solver_failed,
                        "round-off hides a vertex from every shortest path");
        }
    }

    /// A path of length `distance` has reached the vertex.
    void reach(Index vertex, double distance, const GeodesicDistances::Arrival& arrival) {
        double& known = result_.distance[at(vertex)];
        // What improves by round-off alone is no other path, and not worth opening a vertex again.
        if (!(distance < known * (1.0 - tolerance::geodesic_round_off))) return;
        known = distance;
        result_.arrivals[at(vertex)] = arrival;
        if (total_angles_[at(vertex)] > 0.0) {
            buckets_.push({0.0, 0.0, {0, 0}, distance, Window::spawn, vertex}, distance);
        }
    }

    /// All light that leaves the triangle of h through h, from a root in the triangle at
    /// `position`.
    void shine(Index h, const Vec2& position, double offset, Index root) {
        const Index other = half_edges_.twin(h);
        if (other < 0) return;
        const double length = half_edges_.length(h);
        const Window window{0.0,    length, {length - position.x(), -position.y()},
                            offset, other,  root};
        buckets_.push(window, window.least_distance());
    }

    /// Lets paths go on from a vertex, in the directions in which they make no corner that a
    /// shorter path could cut: at least pi from where they came on either side.
    void open(Index vertex) {
        constexpr double margin = tolerance::geodesic_margin;
        const double offset = result_.distance[at(vertex)];
        const bool whole = vertex == result_.source;
        const bool border = half_edges_.on_border(vertex);
        const double total = total_angles_[at(vertex)];
        const double came = whole ? 0.0 : direction_of_arrival(vertex);
        double begin = 0.0;
        for (const Index h : half_edges_.around(vertex)) {
            const double end = begin + half_edges_.angle(h);
            // Turned so that the path came from 0; around an inner vertex modulo the total angle.
            const auto sees = [&](double low, double high) {
                return begin - came <= high + margin && end - came >= low - margin;
            };
            const bool lit = whole || (border ? sees(pi, infinity) || sees(-infinity, -pi)
                                              : sees(pi, total - pi) || sees(pi - total, -pi));
            if (lit) open_triangle(h, offset);
            begin = end;
        }
    }

    void open_triangle(Index h, double offset) {
        const Index vertex = half_edges_.from(h), opposite = HalfEdges::next(h);
        reach(half_edges_.to(h), offset + half_edges_.length(h), {vertex, -1, {0, 0}});
        reach(half_edges_.apex(h), offset + half_edges_.length(HalfEdges::previous(h)),
              {vertex, -1, {0, 0}});
        shine(opposite, half_edges_.apex_position(opposite), offset, vertex);
    }

    /// The angle at the vertex, counted from its first half-edge, towards where its path came from.
    double direction_of_arrival(Index vertex) const {
        const auto& arrival = result_.arrivals[at(vertex)];
        double begin = 0.0;
        for (const Index h : half_edges_.around(vertex)) {
            const Index last = HalfEdges::previous(h), opposite = HalfEdges::next(h);
            if (arrival.half_edge == opposite) {
                const Vec2& apex = half_edges_.apex_position(opposite);
                const Vec2 along_h = -apex, back = arrival.position - apex;
                return begin + signed_angle(along_h, back);
            }
            if (arrival.half_edge < 0 && half_edges_.to(h) == arrival.root) return begin;
            begin += half_edges_.angle(h);
            if (arrival.half_edge < 0 && half_edges_.from(last) == arrival.root) return begin;
        }
        return begin;
    }

    /// Light falls through a triangle: on its third corner and out through both other edges.
    void propagate(const Window& w) {
        const Index h = w.half_edge, left = HalfEdges::previous(h), right = HalfEdges::next(h);
        const Vec2& apex = half_edges_.apex_position(h);
        const double length = half_edges_.length(h), depth = -w.position.y();
        const double slack = tolerance::geodesic_slack * length;
        // Where the line from the root to the apex passes the edge.
        const double split =
            w.position.x() + (apex.x() - w.position.x()) * depth / (apex.y() + depth);
        bool go_left = split > w.begin + slack, go_right = split < w.end - slack;
        if (split >= w.begin - slack && split <= w.end + slack) {
            const double distance = w.offset + (apex - w.position).norm();
            reach(half_edges_.from(left), distance, {w.root, h, w.position});
            Split& best = splits_[at(h)];
            if (distance < best.distance) {
                best = {distance, split};
            } else {  // a nearer root splits here: beyond its line it is nearer everywhere
                if (split < best.x - slack) go_right = false;
                if (split > best.x + slack) go_left = false;
            }
        }
        const double apex_length = half_edges_.length(left);  // from the origin to the apex
        if (go_left) {
            const Vec2 along = apex / apex_length;
            const Vec2 position(along.dot(w.position), cross(along, w.position));
            const auto crossing = [&](double x) {
                return apex_length * x * depth /
                       (depth * apex.x() + apex.y() * (w.position.x() - x));
            };
            const double begin = crossing(w.begin);
            const double end = split <= w.end ? apex_length : crossing(w.end);
            pass(w, half_edges_.twin(left), begin, end, position, half_edges_.to(h),
                 (begin * along - Vec2(length, 0.0)).norm(), true);
        }
        if (go_right) {
            const double side = half_edges_.length(right);
            const Vec2 along = (Vec2(length, 0.0) - apex) / side, from_apex = w.position - apex;
            const Vec2 position(along.dot(from_apex), cross(along, from_apex));
            // Seen from the edge's end, the mirror image of the left side.
            const Vec2 mirrored(length - apex.x(), apex.y());
            const auto crossing = [&](double x) {
                const double y = length - x, root = length - w.position.x();
                return side - side * y * depth / (depth * mirrored.x() + mirrored.y() * (root - y));
            };
            const double begin = split >= w.begin ? 0.0 : crossing(w.begin);
            const double end = crossing(w.end);
            pass(w, half_edges_.twin(right), begin, end, position, half_edges_.from(h),
                 (apex + end * along).norm(), false);
        }
    }

    /// Queues the part of a window that leaves through an edge, unless a path over a vertex is
    /// known to be shorter for all of it: over either end of the edge, or over the corner behind,
    /// from which the way to the window's far end crosses all of its light.
    void pass(const Window& parent, Index h, double begin, double end, const Vec2& position,
              Index behind, double behind_to_far, bool far_is_begin) {
        if (h < 0) return;
        const double length = half_edges_.length(h);
        begin = std::max(begin, 0.0);
        end = std::min(end, length);
        const double slack = tolerance::geodesic_slack * length;
        if (!(end - begin > slack)) return;
        const Window window{begin,         end, {position.x(), std::min(position.y(), 0.0)},
                            parent.offset, h,   parent.root};
        const double at_begin = window.distance_at(begin), at_end = window.distance_at(end);
        if (result_.distance[at(half_edges_.from(h))] + end < at_end - slack) return;
        if (result_.distance[at(half_edges_.to(h))] + length - begin < at_begin - slack) return;
        if (result_.distance[at(behind)] + behind_to_far <
            (far_is_begin ? at_begin : at_end) - slack)
            return;
        buckets_.push(window, window.least_distance());
    }

    /// The nearest root whose light a triangle's third corner splits, and where on the edge.
    struct Split {
        double distance = infinity, x = 0.0;
    };

    const Unfolding& half_edges_;
    const std::vector<double>& total_angles_;
    std::vector<Split> splits_;
    Buckets buckets_;
    GeodesicDistances result_;
};

}  // namespace

ExactGeodesics::ExactGeodesics(const Triangulation& surface, std::size_t windows_per_half_edge)
    : ExactGeodesics(Unfolding(surface, HalfEdges(surface)), windows_per_half_edge) {}

ExactGeodesics::ExactGeodesics(Unfolding unfolding, std::size_t windows_per_half_edge)
    : unfolding_(std::move(unfolding)),
      most_windows_(windows_per_half_edge * at(unfolding_.count())),
      total_angles_(at(unfolding_.vertex_count()), 0.0) {
    for (Index v = 0; v < unfolding_.vertex_count(); ++v) {
        double total = 0.0;
        for (const Index h : unfolding_.around(v)) total += unfolding_.angle(h);
        const double straight = unfolding_.on_border(v) ? pi : 2.0 * pi;
        if (total > straight * (1.0 + tolerance::geodesic_round_off)) total_angles_[at(v)] = total;
    }
}

GeodesicDistances ExactGeodesics::from_vertex(Index vertex, const Progress& progress) const {
    return Propagation(unfolding_, total_angles_, most_windows_).run(vertex, progress);
}

}  // namespace lastflat
