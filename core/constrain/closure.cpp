#include "core/constrain/closure.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <set>

#include "core/error.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

using Edge = std::pair<Index, Index>;

std::string text_of(const char* format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

/// Lengths that rows bound: each a set of edges whose lengths add up.
struct BoundedEdges {
    std::size_t constraint;
    std::set<Edge> edges;
    double least, most;
};

/// The edges whose lengths a row adds up; none: it is not such a row.
std::set<Edge> added_edges(const Row& row) {
    std::set<Edge> edges;
    for (const RowTerm& term : row.terms) {
        const Length* length = std::get_if<Length>(&term.of);
        if (length == nullptr || term.factor != 1.0) return {};
        edges.insert(std::minmax(length->a, length->b));
    }
    return edges;
}

std::vector<BoundedEdges> bounded_edges(const std::vector<ConstraintRow>& rows) {
    std::vector<BoundedEdges> result;
    for (const ConstraintRow& row : rows) {
        auto edges = added_edges(row);
        if (!edges.empty())
            result.push_back({row.constraint, std::move(edges), row.least, row.most});
    }
    return result;
}

/// What a set of edges may be long at most, if rows bound all of it.
struct MostLength {
    bool bounded = true;
    double length = 0.0;
    std::vector<std::size_t> constraints;
};

MostLength most_length(const std::vector<BoundedEdges>& bounds, std::set<Edge> edges) {
    MostLength result;
    for (const BoundedEdges& bound : bounds) {
        if (!std::isfinite(bound.most)) continue;
        std::size_t covered = 0;
        for (const Edge& edge : bound.edges) covered += edges.erase(edge);
        if (covered == 0) continue;
        result.length += bound.most;
        result.constraints.push_back(bound.constraint);
    }
    result.bounded = edges.empty();
    return result;
}

class LoopCheck {
public:
    LoopCheck(const Domain& domain, const std::vector<ConstraintRow>& rows,
              const std::vector<Constraint>& constraints)
        : domain_(domain), rows_(rows), constraints_(constraints), bounds_(bounded_edges(rows)) {
        for (const BoundedEdges& bound : bounds_) {
            const Lock* lock = std::get_if<Lock>(&constraints[bound.constraint].demand);
            if (lock == nullptr || lock->keep != Keep::edges) continue;
            locked_.emplace(*bound.edges.begin(), bound.constraint);
        }
    }

    std::optional<OpenLoop> run() const {
        for (std::size_t r = 0; r < domain_.regions.size(); ++r) {
            for (auto check : {&LoopCheck::pins, &LoopCheck::hubs, &LoopCheck::straight_sides,
                               &LoopCheck::areas}) {
                if (auto found = (this->*check)(r)) return found;
            }
        }
        return std::nullopt;
    }

private:
    [[nodiscard]] OpenLoop loop(std::vector<std::size_t> constraints, double gap, Index vertex,
                                std::string why) const {
        std::sort(constraints.begin(), constraints.end());
        constraints.erase(std::unique(constraints.begin(), constraints.end()), constraints.end());
        return {std::move(constraints), gap, domain_.position(vertex), std::move(why)};
    }

    [[nodiscard]] std::set<Edge> border_edges(std::size_t r) const {
        const auto& border = domain_.regions[r]->border;
        std::set<Edge> edges;
        for (std::size_t i = 0; i < border.size(); ++i) {
            const auto [a, b] = std::minmax(border[i], border[(i + 1) % border.size()]);
            edges.emplace(a + domain_.first[r], b + domain_.first[r]);
        }
        return edges;
    }

    /// Two vertices cannot lie in one point.
    [[nodiscard]] std::optional<OpenLoop> pins(std::size_t r) const {
        std::map<std::pair<double, double>, std::size_t> pinned;  // to the row of the x coordinate
        for (std::size_t k = 0; k + 1 < rows_.size(); ++k) {
            const Coordinate* pin = rows_[k].coordinate();
            if (pin == nullptr || pin->axis != 0) continue;
            if (domain_.region_of(pin->vertex) != r) continue;
            const auto [other, is_new] =
                pinned.emplace(std::pair(rows_[k].most, rows_[k + 1].most), k);
            if (is_new || rows_[other->second].vertex == pin->vertex) continue;
            const ConstraintRow& first = rows_[other->second];
            return loop({first.constraint, rows_[k].constraint},
                        domain_.distance(first.vertex, pin->vertex), pin->vertex,
                        "two vertices cannot lie in one point");
        }
        return std::nullopt;
    }

    struct Hub {
        double angle = 0.0, spokes = 0.0;
        int triangles = 0;
        bool locked = true;
        std::vector<std::size_t> constraints;
    };

    [[nodiscard]] std::optional<OpenLoop> hubs(std::size_t r) const {
        const Region& region = *domain_.regions[r];
        const auto on_border = border_mask(region);
        std::map<Index, Hub> hubs;
        for (const auto& [edge, constraint] : locked_) {
            for (const Index v : {edge.first - domain_.first[r], edge.second - domain_.first[r]}) {
                const bool here = v >= 0 && v < static_cast<Index>(region.positions.size());
                if (here && !on_border[static_cast<std::size_t>(v)]) hubs[v];
            }
        }
        if (hubs.empty()) return std::nullopt;
        for (const Triangle& t : region.triangles) {
            for (std::size_t i = 0; i < 3; ++i) {
                const auto hub = hubs.find(t[i]);
                if (hub != hubs.end()) add_corner(region, domain_.first[r], t, i, hub->second);
            }
        }
        for (const auto& [v, hub] : hubs) {
            const double gap = 2.0 * std::numbers::pi - hub.angle;
            if (!hub.locked || std::abs(gap) <= tolerance::full_turn) continue;
            const Index vertex = v + domain_.first[r];
            return loop(hub.constraints, gap * hub.spokes / hub.triangles, vertex,
                        "the locked edges around " + position_text(domain_.position(vertex)) +
                            " do not close: their angles miss a full turn by " +
                            text_of("%.3g degrees", gap * 180.0 / std::numbers::pi));
        }
        return std::nullopt;
    }

    void add_corner(const Region& region, Index first, const Triangle& t, std::size_t corner,
                    Hub& hub) const {
        if (!hub.locked) return;
        const Index a = t[corner], b = t[(corner + 1) % 3], c = t[(corner + 2) % 3];
        for (const Edge& edge : {Edge(a, b), Edge(b, c), Edge(c, a)}) {
            const auto found = locked_.find(std::minmax(edge.first + first, edge.second + first));
            hub.locked = hub.locked && found != locked_.end();
            if (hub.locked) hub.constraints.push_back(found->second);
        }
        const Vec3 p = region.position(b) - region.position(a);
        const Vec3 q = region.position(c) - region.position(a);
        hub.angle += std::acos(std::clamp(p.normalized().dot(q.normalized()), -1.0, 1.0));
        hub.spokes += p.norm();
        ++hub.triangles;
    }

    [[nodiscard]] std::optional<OpenLoop> straight_sides(std::size_t r) const {
        std::set<std::size_t> straight;  // constraints with rows in this region
        for (const ConstraintRow& row : rows_) {
            if (std::holds_alternative<Straight>(constraints_[row.constraint].demand) &&
                domain_.region_of(row.vertex) == r)
                straight.insert(row.constraint);
        }
        for (const std::size_t c : straight) {
            for (const CurveRun& run : domain_.regions[r]->runs) {
                if (run.curve != std::get<Straight>(constraints_[c].demand).curve) continue;
                if (auto found = straight_side(r, c, run)) return found;
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] std::optional<OpenLoop> straight_side(std::size_t r, std::size_t c,
                                                        const CurveRun& run) const {
        std::set<Edge> side, rest = border_edges(r);
        for (std::size_t i = 1; i < run.vertices.size(); ++i) {
            const auto [a, b] = std::minmax(run.vertices[i - 1], run.vertices[i]);
            side.emplace(a + domain_.first[r], b + domain_.first[r]);
        }
        for (const Edge& edge : side) {
            if (rest.erase(edge) == 0) return std::nullopt;  // not a side of the border
        }
        double least = 0.0;
        std::vector<std::size_t> fighting{c};
        for (const BoundedEdges& bound : bounds_) {
            const bool inside = std::all_of(bound.edges.begin(), bound.edges.end(),
                                            [&](const Edge& edge) { return side.count(edge) > 0; });
            if (!inside || !(bound.least > 0.0)) continue;
            least += bound.least;
            fighting.push_back(bound.constraint);
            for (const Edge& edge : bound.edges) side.erase(edge);
        }
        const MostLength most = most_length(bounds_, rest);
        const double gap = least - most.length;
        if (!most.bounded || gap <= tolerance::locked_length * least) return std::nullopt;
        fighting.insert(fighting.end(), most.constraints.begin(), most.constraints.end());
        return loop(std::move(fighting), gap, run.vertices.front() + domain_.first[r],
                    "the straight side is longer than the other sides may be together, by " +
                        text_of("%.3g mm", gap));
    }

    [[nodiscard]] std::optional<OpenLoop> areas(std::size_t r) const {
        const MostLength perimeter = most_length(bounds_, border_edges(r));
        if (!perimeter.bounded) return std::nullopt;
        for (const ConstraintRow& row : rows_) {
            if (!std::holds_alternative<TotalArea>(constraints_[row.constraint].demand)) continue;
            if (domain_.region_of(row.vertex) != r || !(row.least > 0.0)) continue;
            const double needed = std::sqrt(4.0 * std::numbers::pi * row.least * row.reference);
            const double gap = needed - perimeter.length;
            if (gap <= tolerance::locked_length * needed) continue;
            auto fighting = perimeter.constraints;
            fighting.push_back(row.constraint);
            return loop(std::move(fighting), gap, row.vertex,
                        "even a circle of that area has a longer border than the locks leave, by " +
                            text_of("%.3g mm", gap));
        }
        return std::nullopt;
    }

    const Domain& domain_;
    const std::vector<ConstraintRow>& rows_;
    const std::vector<Constraint>& constraints_;
    const std::vector<BoundedEdges> bounds_;
    std::map<Edge, std::size_t> locked_;
};

}  // namespace

std::optional<OpenLoop> open_loop(const Domain& domain, const std::vector<ConstraintRow>& rows,
                                  const std::vector<Constraint>& constraints) {
    return LoopCheck(domain, rows, constraints).run();
}

}  // namespace lastflat
