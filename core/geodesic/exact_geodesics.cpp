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
        do {
            propagate_all(progress);
        } while (follow_edges());
        return std::move(result_);
    }

private:
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    static constexpr double less = 1.0 - tolerance::geodesic_round_off;  ///< times a distance

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
    }

    /// What light should have reached along an edge but has not, for whatever reason, is reached
    /// along it. False: there is nothing.
    bool follow_edges() {
        bool any = false;
        for (Index v = 0; v < half_edges_.vertex_count(); ++v) {
            const auto follow = [&](Index from, double length) {
                const double distance = result_.distance[at(from)] + length;
                if (!(distance < result_.distance[at(v)] * less)) return;
                reach(v, distance, {from, -1, {0, 0}});
                any = true;
            };
            if (half_edges_.outgoing(v) < 0) continue;
            for (const Index h : half_edges_.around(v)) {
                follow(half_edges_.to(h), half_edges_.length(h));
                follow(half_edges_.apex(h), half_edges_.length(HalfEdges::previous(h)));
            }
        }
        return any;
    }

    /// A path of length `distance` has reached the vertex.
    void reach(Index vertex, double distance, const GeodesicDistances::Arrival& arrival) {
        double& known = result_.distance[at(vertex)];
        if (!(distance < known * less)) {
            // Of paths that round-off cannot tell apart the straighter one knows its direction.
            const Index root = result_.arrivals[at(vertex)].root;
            const bool straighter =
                distance * less < known &&
                result_.distance[at(arrival.root)] < result_.distance[at(root)] * less;
            if (!straighter) return;
        }
        known = std::min(known, distance);
        result_.arrivals[at(vertex)] = arrival;
        if (total_angles_[at(vertex)] > 0.0) {
            buckets_.push({0.0, 0.0, {0, 0}, distance, Window::spawn, vertex}, distance);
        }
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
            const auto light = [&](double low, double high) {
                low = std::max(low - margin, begin - came);
                high = std::min(high + margin, end - came);
                if (low <= high) open_triangle(h, offset, low + came - begin, high + came - begin);
            };
            if (whole) {
                light(-infinity, infinity);
            } else {
                light(pi, border ? infinity : total - pi);
                light(border ? -infinity : pi - total, -pi);
            }
            begin = end;
        }
    }

    /// Light from where h begins, between two angles from h on.
    void open_triangle(Index h, double offset, double low, double high) {
        const Index vertex = half_edges_.from(h), opposite = HalfEdges::next(h);
        reach(half_edges_.to(h), offset + half_edges_.length(h), {vertex, -1, {0, 0}});
        reach(half_edges_.apex(h), offset + half_edges_.length(HalfEdges::previous(h)),
              {vertex, -1, {0, 0}});
        const Index other = half_edges_.twin(opposite);
        if (other < 0) return;
        const Vec2& root = half_edges_.apex_position(opposite);
        const double length = half_edges_.length(opposite), first = std::atan2(root.x(), root.y());
        const auto crossing = [&](double angle) {
            return std::clamp(root.x() + root.y() * std::tan(angle - first), 0.0, length);
        };
        const double begin = low > 0.0 ? crossing(low) : 0.0;
        const double end = high < half_edges_.angle(h) ? crossing(high) : length;
        const Window window{length - end, length - begin, {length - root.x(), -root.y()},
                            offset,       other,          vertex};
        buckets_.push(window, window.least_distance());
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
    ///
    /// What the rays at the window's ends miss by round-off alone they meet. So that no direction
    /// is lost between two windows that share such a ray, less is taken for met where light ends
    /// than where its neighbour is widened to the corner instead.
    void propagate(const Window& w) {
        const Index h = w.half_edge, left = HalfEdges::previous(h);
        const Vec2& apex = half_edges_.apex_position(h);
        const double length = half_edges_.length(h), depth = -w.position.y();
        const Vec2 ray = apex - w.position;
        const Vec2 first(w.begin - w.position.x(), depth), last(w.end - w.position.x(), depth);
        const double beyond_first = cross(ray, first), beyond_last = cross(last, ray);
        const double scale = length + half_edges_.length(left), reached = taxicab(ray);
        const auto round_off = [&](const Vec2& side) {
            const double far = taxicab(side);
            return tolerance::geodesic_ray * (reached * far + scale * (reached + far));
        };
        const double off_first = round_off(first), off_last = round_off(last);
        bool go_left = beyond_first > off_first, go_right = beyond_last > off_last;
        const bool from_apex = beyond_first >= -2.0 * off_first;
        const bool to_apex = beyond_last >= -2.0 * off_last;
        if (from_apex && to_apex) {
            const double distance = w.offset + ray.norm();
            reach(half_edges_.from(left), distance, {w.root, h, w.position});
            const double slack = tolerance::geodesic_slack * length;
            const double split = w.position.x() + ray.x() * depth / ray.y();
            Split& best = splits_[at(h)];
            if (distance < best.distance) {
                best = {distance, split};
            } else {  // a nearer root splits here: beyond its line it is nearer everywhere
                if (split < best.x - slack) go_right = false;
                if (split > best.x + slack) go_left = false;
            }
        }
        if (go_left) pass_left(w, beyond_first, to_apex ? 0.0 : -beyond_last);
        if (go_right) pass_right(w, from_apex ? 0.0 : -beyond_first, beyond_last);
    }

    /// Out through the edge that ends where h begins; `at_begin`, `at_end`: how far the rays of the
    /// window's ends pass the third corner (their cross product), 0 where it is the corner itself.
    void pass_left(const Window& w, double at_begin, double at_end) {
        const Index h = w.half_edge, left = HalfEdges::previous(h);
        const double side = half_edges_.length(left), depth = -w.position.y();
        const Vec2 along = half_edges_.apex_position(h) / side;
        const double begin = side * share_crossed(w.begin * depth, at_begin);
        const double end = side * share_crossed(w.end * depth, at_end);
        const Vec2 position(along.dot(w.position), cross(along, w.position));
        const double to_far = (begin * along - Vec2(half_edges_.length(h), 0.0)).norm();
        pass(w, half_edges_.twin(left), begin, end, position, half_edges_.to(h), to_far, true);
    }

    /// The mirror image, seen from the end of h.
    void pass_right(const Window& w, double at_begin, double at_end) {
        const Index h = w.half_edge, right = HalfEdges::next(h);
        const double length = half_edges_.length(h), side = half_edges_.length(right);
        const double depth = -w.position.y();
        const Vec2& apex = half_edges_.apex_position(h);
        const Vec2 along = (Vec2(length, 0.0) - apex) / side, from_apex = w.position - apex;
        const double begin = side - side * share_crossed((length - w.begin) * depth, at_begin);
        const double end = side - side * share_crossed((length - w.end) * depth, at_end);
        const Vec2 position(along.dot(from_apex), cross(along, from_apex));
        pass(w, half_edges_.twin(right), begin, end, position, half_edges_.from(h),
             (apex + end * along).norm(), false);
    }

    /// Where a ray crosses a side, from the corner that it shares with h on, given twice the areas
    /// on either side of the ray.
    static double share_crossed(double before, double beyond) {
        return beyond > 0.0 ? before / (before + beyond) : 1.0;
    }
    static double taxicab(const Vec2& v) { return std::abs(v.x()) + std::abs(v.y()); }

    /// Queues the part of a window that leaves through an edge, unless a path over a vertex is
    /// known to be shorter for all of it: over either end of the edge, or over the corner behind,
    /// from which the way to the window's far end crosses all of its light.
    void pass(const Window& parent, Index h, double begin, double end, const Vec2& position,
              Index behind, double behind_to_far, bool far_is_begin) {
        if (h < 0) return;
        const double length = half_edges_.length(h);
        end = std::max(begin, end);
        const double slack = tolerance::geodesic_slack * length;
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
