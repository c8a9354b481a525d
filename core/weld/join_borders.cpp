#include "core/weld/join_borders.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>

#include "core/numerics/box_tree.h"
#include "core/numerics/tolerances.h"
#include "core/weld/borders.h"
#include "core/weld/sides.h"

namespace lastflat {
namespace {

constexpr int most_rounds = 8;
/// The way along the border between two points that are joined is so many times their distance.
constexpr double least_detour = 4.0;

/// One edge of a border loop, and its first vertex.
struct Stretch {
    std::size_t loop, at;
};

class Borders {
public:
    Borders(const Faces& faces, double tolerance)
        : faces_(faces), tolerance_(tolerance), loops_(border_loops(faces)) {
        std::vector<Box3> boxes;
        for (std::size_t l = 0; l < loops_.size(); ++l) {
            for (std::size_t i = 0; i < loops_[l].size(); ++i) {
                stretches_.push_back({l, i});
                Box3 box(position(stretches_.back()));
                boxes.push_back(box.extend(position({l, i + 1})));
            }
        }
        tree_.emplace(boxes);
        for (std::size_t s = 0; s < stretches_.size(); ++s) partners_.push_back(partner_of(s));
    }

    /// Vertices that are nearest to each other, as pairs of a vertex and the smaller one.
    [[nodiscard]] std::map<Index, Index> pairs() const {
        std::map<Index, Index> found;
        std::set<Index> taken;
        for (std::size_t s = 0; s < stretches_.size(); ++s) {
            const auto& other = partners_[s];
            if (!other || partners_[*other] != s) continue;
            const Index v = vertex(stretches_[s]), w = vertex(stretches_[*other]);
            if (v <= w || taken.count(v) > 0 || taken.count(w) > 0) continue;
            taken.insert({v, w});
            found[v] = w;
        }
        return found;
    }

    /// Vertices without a partner, at the edges that they face, in the order along each.
    [[nodiscard]] Insertions insertions(double& furthest) const {
        std::map<std::pair<Index, Index>, std::vector<std::pair<double, Index>>> found;
        std::set<Index> taken;
        for (std::size_t s = 0; s < stretches_.size(); ++s) {
            const Index v = vertex(stretches_[s]);
            const bool has_pair = partners_[s] && partners_[*partners_[s]] == s;
            if (has_pair || taken.count(v) > 0) continue;
            const auto edge = edge_at(s);
            if (!edge) continue;
            taken.insert(v);
            furthest = std::max(furthest, edge->distance);
            found[{vertex(edge->stretch), vertex(next(edge->stretch))}].emplace_back(edge->share,
                                                                                     v);
        }
        Insertions insertions;
        for (auto& [edge, vertices] : found) {
            std::sort(vertices.begin(), vertices.end());
            for (const auto& [share, v] : vertices) insertions[edge].push_back(v);
        }
        return insertions;
    }

private:
    struct FacedEdge {
        Stretch stretch;
        double share, distance;
    };

    [[nodiscard]] Index vertex(const Stretch& s) const { return loops_[s.loop].vertex(s.at); }
    [[nodiscard]] static Stretch next(const Stretch& s) { return {s.loop, s.at + 1}; }
    [[nodiscard]] const Vec3& position(const Stretch& s) const {
        return faces_.position(vertex(s));
    }

    /// Whether a way along the border from one to the other is no detour.
    [[nodiscard]] bool are_neighbours(const Stretch& a, const Stretch& b, double distance) const {
        if (a.loop != b.loop) return false;
        const Loop& loop = loops_[a.loop];
        const double apart =
            std::abs(loop.along[a.at % loop.size()] - loop.along[b.at % loop.size()]);
        return std::min(apart, loop.length - apart) <= least_detour * distance;
    }

    template <class Visit>
    void for_near(const Vec3& at, double reach, const Visit& visit) const {
        const Box3 box(at - Vec3::Constant(reach), at + Vec3::Constant(reach));
        tree_->find(box, [&](Index s) {
            visit(static_cast<std::size_t>(s));
            return false;
        });
    }

    /// The nearest vertex across a gap.
    [[nodiscard]] std::optional<std::size_t> partner_of(std::size_t s) const {
        const Stretch& own = stretches_[s];
        std::optional<std::size_t> best;
        double least = tolerance_;
        for_near(position(own), tolerance_, [&](std::size_t other) {
            const Stretch& there = stretches_[other];
            if (vertex(there) == vertex(own)) return;
            const double distance = (position(there) - position(own)).norm();
            if (distance > least || are_neighbours(own, there, distance)) return;
            least = distance;
            best = other;
        });
        return best;
    }

    /// The nearest edge across a gap, if the vertex faces its inside.
    [[nodiscard]] std::optional<FacedEdge> edge_at(std::size_t s) const {
        const Stretch& own = stretches_[s];
        const Vec3& at = position(own);
        const Stretch before{own.loop, own.at + loops_[own.loop].size() - 1};
        const double needle = tolerance::needle * std::min((position(before) - at).norm(),
                                                           (position(next(own)) - at).norm());
        std::optional<FacedEdge> best;
        double least = tolerance_;
        for_near(at, tolerance_, [&](std::size_t other) {
            const Stretch& edge = stretches_[other];
            if (vertex(edge) == vertex(own) || vertex(next(edge)) == vertex(own)) return;
            const Vec3& from = position(edge);
            const Vec3 way = position(next(edge)) - from;
            const double share = way.dot(at - from) / way.squaredNorm();
            const double room = std::min(share, 1.0 - share) * way.norm();
            if (!(room > needle)) return;
            const double distance = (from + share * way - at).norm();
            if (distance > least || are_neighbours(own, edge, distance) ||
                are_neighbours(own, next(edge), distance))
                return;
            least = distance;
            best = FacedEdge{edge, share, distance};
        });
        return best;
    }

    const Faces& faces_;
    const double tolerance_;
    const std::vector<Loop> loops_;
    std::vector<Stretch> stretches_;
    std::optional<BoxTree<Box3>> tree_;
    std::vector<std::optional<std::size_t>> partners_;  ///< per stretch, of its first vertex
};

bool every_edge_has_two_sides_at_most(const Faces& faces) {
    bool sound = true;
    for_each_edge(faces.sides(),
                  [&](auto first, auto last) { sound = sound && last - first <= 2; });
    return sound;
}

/// Whether anything was joined.
bool join_once(Faces& faces, double tolerance, double& furthest, RepairNote& joined,
               RepairNote& inserted) {
    const std::map<Index, Index> pairs = Borders(faces, tolerance).pairs();
    for (const auto& [v, w] : pairs) {
        Vec3& position = faces.positions[static_cast<std::size_t>(w)];
        const Vec3 middle = 0.5 * (position + faces.position(v));
        furthest = std::max(furthest, (middle - position).norm());
        position = middle;
        joined.at(middle);
    }
    rename_vertices(faces, pairs);
    const Insertions insertions = Borders(faces, tolerance).insertions(furthest);
    for (const auto& [edge, vertices] : insertions) {
        for (const Index v : vertices) inserted.at(faces.position(v));
    }
    insert_into_edges(faces, insertions);
    return !pairs.empty() || !insertions.empty();
}

}  // namespace

double join_borders(Faces& faces, double tolerance_mm, RepairNote& joined, RepairNote& inserted) {
    Faces trial = faces;
    RepairNote trial_joined = joined, trial_inserted = inserted;
    double furthest = 0.0;
    int rounds = 0;
    while (rounds < most_rounds &&
           join_once(trial, tolerance_mm, furthest, trial_joined, trial_inserted))
        ++rounds;
    if (rounds == 0 || !every_edge_has_two_sides_at_most(trial)) return 0.0;
    faces = std::move(trial);
    joined = trial_joined;
    inserted = trial_inserted;
    return furthest;
}

}  // namespace lastflat
