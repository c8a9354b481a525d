#include "core/constrain/constraint_rows.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/constrain/pins.h"
#include "core/cut/seam_stretches.h"
#include "core/error.h"
#include "core/numerics/disjoint_sets.h"
#include "core/numerics/polygon.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

using Edge = std::pair<Index, Index>;

/// A stretch of a curve, in the domain's vertices.
using Side = std::vector<Index>;

/// Stretches of curves, each with the index of its region.
using Sides = std::vector<std::pair<std::size_t, const CurveRun*>>;

Sides runs_of(const std::vector<const Region*>& regions, const std::string& curve,
              const std::string& region) {
    Sides runs;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        if (!binds(region, *regions[r])) continue;
        for (const CurveRun& run : regions[r]->runs) {
            if (run.curve == curve) runs.emplace_back(r, &run);
        }
    }
    return runs;
}

/// The two sides of a match, if it names two.
Sides match_sides(const std::vector<const Region*>& regions, const Match& match) {
    Sides sides = runs_of(regions, match.curve, match.region);
    if (match.curve == match.with_curve && match.region == match.with_region) return sides;
    const Sides others = runs_of(regions, match.with_curve, match.with_region);
    if (sides.size() != 1 || others.size() != 1) return {};
    sides.push_back(others.front());
    return sides;
}

class RowBuilder {
public:
    RowBuilder(const Domain& domain, const std::vector<Constraint>& constraints)
        : domain_(domain), constraints_(constraints) {
        for (const Region* region : domain.regions) areas_.push_back(surface_area(*region));
    }

    std::vector<ConstraintRow> run() {
        for (current_ = 0; current_ < constraints_.size(); ++current_) {
            std::visit([&](const auto& demand) { add(demand); }, constraints_[current_].demand);
        }
        return std::move(rows_);
    }

private:
    void add(const Lock& lock) {
        for (const Side& side : sides(lock)) {
            if (lock.keep == Keep::edges)
                lock_edges(side);
            else
                bound_length(side, 0.0, 0.0);
        }
    }

    void add(const Range& range) {
        for (const Side& side : sides(range))
            bound_length(side, range.min_percent, range.max_percent);
    }

    void add(const Match& asked) {
        const auto both = in_domain(match_sides(domain_.regions, asked));
        if (both.size() == 2) match(both[0], both[1]);  // else they are in another domain
    }

    void add(const Straight& straight) {
        for (const Side& side : sides(straight)) straighten(side);
    }

    void add(const TotalArea& area) {
        for (std::size_t r = 0; r < domain_.regions.size(); ++r) {
            if (binds(area.region, *domain_.regions[r])) bound_area(r, area);
        }
    }

    void add(const Pin& pin) {
        for (std::size_t r = 0; r < domain_.regions.size(); ++r) {
            const auto pinned = pinned_vertices(*domain_.regions[r], pin);
            if (!pinned.empty()) hold(r, pinned.front());
        }
    }

    void add(const Seam& seam) {
        for (const SeamStretch& both : seam_stretches(domain_.regions, seam.curve))
            match(in_domain(both.a.region, both.a.vertices),
                  in_domain(both.b.region, both.b.vertices));
    }

    /// Of a curve, where the constraint binds it.
    template <class OfCurve>
    [[nodiscard]] std::vector<Side> sides(const OfCurve& demand) const {
        return in_domain(runs_of(domain_.regions, demand.curve, demand.region));
    }

    [[nodiscard]] Side in_domain(std::size_t r, Side side) const {
        for (Index& v : side) v += domain_.first[r];
        return side;
    }

    [[nodiscard]] std::vector<Side> in_domain(const Sides& runs) const {
        std::vector<Side> result;
        for (const auto& [r, run] : runs) result.push_back(in_domain(r, run->vertices));
        return result;
    }

    void add_row(std::vector<RowTerm> terms, double least, double most, double reference,
                 Index vertex) {
        rows_.push_back({{std::move(terms), least, most, reference, vertex}, current_});
    }

    /// Adds the terms of the side's length; returns its length on the surface.
    double add_length(const Side& side, double factor, std::vector<RowTerm>& terms) const {
        double length = 0.0;
        for (std::size_t i = 1; i < side.size(); ++i) {
            const Index a = side[i - 1], b = side[i];
            terms.push_back({factor, Length{a, b}});
            length += domain_.distance(a, b);
        }
        return length;
    }

    void lock_edges(const Side& side) {
        for (std::size_t i = 1; i < side.size(); ++i) {
            const auto [a, b] = std::minmax(side[i - 1], side[i]);
            const double length = domain_.distance(a, b);
            add_row({{1.0, Length{a, b}}}, length, length, length, a);
        }
    }

    /// The length of a whole side: exact, or in a range.
    void bound_length(const Side& side, double min_percent, double max_percent) {
        std::vector<RowTerm> terms;
        const double length = add_length(side, 1.0, terms);
        add_row(std::move(terms), length * (1.0 + min_percent / 100.0),
                length * (1.0 + max_percent / 100.0), length, side.front());
    }

    void match(const Side& a, const Side& b) {
        std::vector<RowTerm> terms;
        const double length = add_length(a, 1.0, terms);
        add_length(b, -1.0, terms);
        add_row(std::move(terms), 0.0, 0.0, length, a.front());
    }

    /// Every three consecutive points on a line: their triangle over their distance in space.
    void straighten(const Side& side) {
        const double chord = domain_.distance(side.front(), side.back());
        for (std::size_t i = 2; i < side.size(); ++i) {
            const Index a = side[i - 2], b = side[i - 1], c = side[i];
            const double base = domain_.distance(a, c);
            if (!(base > 0.0)) continue;  // a closed curve of two edges
            add_row(
                {{1.0 / base, Cross{a, b}}, {1.0 / base, Cross{b, c}}, {1.0 / base, Cross{c, a}}},
                0.0, 0.0, std::max(chord, base), b);
        }
    }

    void bound_area(std::size_t r, const TotalArea& bounds) {
        const Region& region = *domain_.regions[r];
        const double area = areas_[r], size = std::sqrt(area);
        std::vector<RowTerm> terms;
        for (const auto& loop : border_loops(region)) {
            for (std::size_t i = 0; i < loop.size(); ++i)
                terms.push_back(
                    {0.5 / size, Cross{loop[i] + domain_.first[r],
                                       loop[(i + 1) % loop.size()] + domain_.first[r]}});
        }
        add_row(std::move(terms), area / size * (1.0 + bounds.min_percent / 100.0),
                area / size * (1.0 + bounds.max_percent / 100.0), size,
                region.border.front() + domain_.first[r]);
    }

    void hold(std::size_t r, const PinnedVertex& pinned) {
        const Index v = pinned.vertex + domain_.first[r];
        const double size = std::sqrt(areas_[r]);
        for (Index axis = 0; axis < 2; ++axis) {
            const double at = pinned.at[axis];
            add_row({{1.0, Coordinate{v, axis}}}, at, at, size, v);
        }
    }

    const Domain& domain_;
    const std::vector<Constraint>& constraints_;
    std::vector<double> areas_;  ///< of the regions
    std::size_t current_ = 0;
    std::vector<ConstraintRow> rows_;
};

/// Equations between lengths of edges, each solved for its first edge.
class LengthEquations {
public:
    /// Whether the row follows from those before it; if not, it is one of them from now on. Rows
    /// of other things than lengths follow from nothing.
    bool imply(const ConstraintRow& row) {
        if (!row.is_equation()) return false;
        Equation equation{{}, row.most, std::abs(row.most)};
        for (const RowTerm& term : row.terms) {
            const Length* length = std::get_if<Length>(&term.of);
            if (length == nullptr) return false;
            equation.factors[std::minmax(length->a, length->b)] += term.factor;
        }
        reduce(equation);
        if (!equation.factors.empty()) {
            const Edge first = equation.factors.begin()->first;
            solved_.emplace(first, std::move(equation));
            return false;
        }
        return std::abs(equation.sum) <= tolerance::dependent_row * equation.size;
    }

private:
    struct Equation {
        std::map<Edge, double> factors;
        double sum;
        double size;  ///< of what was added up to it
    };

    void reduce(Equation& equation) const {
        for (auto at = equation.factors.begin(); at != equation.factors.end();) {
            const auto known = solved_.find(at->first);
            const double factor = at->second;
            if (factor == 0.0 || known == solved_.end()) {
                at = factor == 0.0 ? equation.factors.erase(at) : std::next(at);
                continue;
            }
            const Equation& other = known->second;
            const double times = factor / other.factors.begin()->second;
            for (const auto& [edge, share] : other.factors) equation.factors[edge] -= times * share;
            at->second = 0.0;
            equation.sum -= times * other.sum;
            equation.size += std::abs(times * other.sum);
        }
    }

    std::map<Edge, Equation> solved_;
};

/// The regions that a constraint has on its two sides.
std::vector<std::pair<std::size_t, std::size_t>> coupled_by(
    const Constraint& constraint, const std::vector<const Region*>& regions) {
    std::vector<std::pair<std::size_t, std::size_t>> couples;
    const auto refuse = [&](const std::string& why) {
        throw Error(ErrorCode::curve_invalid, title(constraint) + ": " + why)
            .at_option(constraint.option);
    };
    if (const Match* match = std::get_if<Match>(&constraint.demand)) {
        const Sides sides = match_sides(regions, *match);
        if (sides.size() != 2)
            refuse("each side must be one stretch of a curve; name the regions that they are in");
        couples.emplace_back(sides[0].first, sides[1].first);
    } else if (const Seam* seam = std::get_if<Seam>(&constraint.demand)) {
        for (const SeamStretch& both : seam_stretches(regions, seam->curve))
            couples.emplace_back(both.a.region, both.b.region);
        if (couples.empty())
            refuse(
                "nowhere do the regions lie on both sides of it (the border has one, and a slit of "
                "one edge does not open)");
    }
    return couples;
}

}  // namespace

std::vector<ConstraintRow> constraint_rows(const Domain& domain,
                                           const std::vector<Constraint>& constraints) {
    return RowBuilder(domain, constraints).run();
}

std::vector<Wire> locked_wires(const Domain& domain, const std::vector<Constraint>& constraints) {
    std::vector<Wire> wires;
    for (std::size_t r = 0; r < domain.regions.size(); ++r) {
        for (const CurveRun* run : runs_locked_by_edges(*domain.regions[r], constraints))
            wires.push_back({r, run->vertices});
    }
    return wires;
}

std::vector<std::size_t> distinct_rows(const std::vector<ConstraintRow>& rows,
                                       const std::vector<std::size_t>& chosen) {
    // Single edges first: it is the sums over them that go.
    std::vector<std::size_t> order = chosen, distinct;
    std::stable_partition(order.begin(), order.end(),
                          [&](std::size_t k) { return rows[k].terms.size() == 1; });
    LengthEquations known;
    for (const std::size_t k : order) {
        if (!known.imply(rows[k])) distinct.push_back(k);
    }
    std::sort(distinct.begin(), distinct.end());
    return distinct;
}

std::vector<std::vector<std::size_t>> coupled_regions(const std::vector<Region>& regions,
                                                      const std::vector<Constraint>& constraints) {
    std::vector<const Region*> all(regions.size());
    std::transform(regions.begin(), regions.end(), all.begin(),
                   [](const Region& region) { return &region; });
    DisjointSets sets(regions.size());
    for (const Constraint& constraint : constraints) {
        for (const auto& [a, b] : coupled_by(constraint, all))
            sets.join(static_cast<Index>(a), static_cast<Index>(b));
    }
    std::vector<std::vector<std::size_t>> groups(regions.size());
    for (std::size_t r = 0; r < regions.size(); ++r)
        groups[static_cast<std::size_t>(sets.find(static_cast<Index>(r)))].push_back(r);
    groups.erase(std::remove_if(groups.begin(), groups.end(),
                                [](const auto& group) { return group.empty(); }),
                 groups.end());
    std::sort(groups.begin(), groups.end());
    return groups;
}

}  // namespace lastflat
