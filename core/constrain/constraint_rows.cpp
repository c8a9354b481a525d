#include "core/constrain/constraint_rows.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.h"
#include "core/numerics/disjoint_sets.h"
#include "core/numerics/polygon.h"

namespace lastflat {
namespace {

using Edge = std::pair<Index, Index>;

/// A stretch of a curve, in the domain's vertices.
struct Side {
    std::vector<Index> vertices;
};

bool names(const std::string& wanted, const std::string& region) {
    return wanted.empty() || wanted == region;
}

/// Stretches of curves, each with the place of its region.
using Sides = std::vector<std::pair<std::size_t, const CurveRun*>>;

Sides runs_of(const std::vector<const Region*>& regions, const std::string& curve,
              const std::string& region) {
    Sides runs;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        if (!names(region, regions[r]->name)) continue;
        for (const CurveRun& run : regions[r]->runs) {
            if (run.curve == curve) runs.emplace_back(r, &run);
        }
    }
    return runs;
}

/// The two sides of a match, if it names two.
Sides match_sides(const std::vector<const Region*>& regions, const Constraint& match) {
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
        for (current_ = 0; current_ < constraints_.size(); ++current_) add_rows();
        return std::move(rows_);
    }

private:
    [[nodiscard]] const Constraint& constraint() const { return constraints_[current_]; }

    [[nodiscard]] std::vector<Side> sides() const {
        return in_domain(runs_of(domain_.regions, constraint().curve, constraint().region));
    }

    [[nodiscard]] std::vector<Side> in_domain(const Sides& runs) const {
        std::vector<Side> result;
        for (const auto& [r, run] : runs) {
            Side side{run->vertices};
            for (Index& v : side.vertices) v += domain_.first[r];
            result.push_back(std::move(side));
        }
        return result;
    }

    void add_rows() {
        const ConstraintKind kind = constraint().kind;
        if (kind == ConstraintKind::match) return add_match();
        if (kind == ConstraintKind::pin) return add_pin();
        if (kind == ConstraintKind::total_area) {
            for (std::size_t r = 0; r < domain_.regions.size(); ++r) {
                if (names(constraint().region, domain_.regions[r]->name)) add_area(r);
            }
            return;
        }
        for (const Side& side : sides()) {
            if (kind == ConstraintKind::straight)
                add_straight(side);
            else if (kind == ConstraintKind::lock && constraint().keep == Keep::edges)
                lock_edges(side);
            else
                bound_length(side);
        }
    }

    void add(std::vector<Term> terms, double least, double most, double reference, Index vertex) {
        rows_.push_back({current_, std::move(terms), least, most, reference, vertex});
    }

    /// Adds the terms of the side's length; returns its length on the surface.
    double add_length(const Side& side, double factor, std::vector<Term>& terms) const {
        double length = 0.0;
        for (std::size_t i = 1; i < side.vertices.size(); ++i) {
            const Index a = side.vertices[i - 1], b = side.vertices[i];
            terms.push_back({TermKind::length, factor, a, b});
            length += domain_.distance(a, b);
        }
        return length;
    }

    void lock_edges(const Side& side) {
        for (std::size_t i = 1; i < side.vertices.size(); ++i) {
            const auto [a, b] = std::minmax(side.vertices[i - 1], side.vertices[i]);
            const double length = domain_.distance(a, b);
            add({{TermKind::length, 1.0, a, b}}, length, length, length, a);
        }
    }

    /// The length of a whole side: exact, or in a range.
    void bound_length(const Side& side) {
        std::vector<Term> terms;
        const double length = add_length(side, 1.0, terms);
        add(std::move(terms), length * (1.0 + constraint().min_percent / 100.0),
            length * (1.0 + constraint().max_percent / 100.0), length, side.vertices.front());
    }

    void add_match() {
        const auto both = in_domain(match_sides(domain_.regions, constraint()));
        if (both.size() != 2) return;  // they are in another domain
        std::vector<Term> terms;
        const double length = add_length(both[0], 1.0, terms);
        add_length(both[1], -1.0, terms);
        add(std::move(terms), 0.0, 0.0, length, both[0].vertices.front());
    }

    /// Every three consecutive points on a line: their triangle over their distance in space.
    void add_straight(const Side& side) {
        const double chord = domain_.distance(side.vertices.front(), side.vertices.back());
        for (std::size_t i = 2; i < side.vertices.size(); ++i) {
            const Index a = side.vertices[i - 2], b = side.vertices[i - 1], c = side.vertices[i];
            const double base = domain_.distance(a, c);
            if (!(base > 0.0)) continue;  // a closed curve of two edges
            add({{TermKind::cross, 1.0 / base, a, b},
                 {TermKind::cross, 1.0 / base, b, c},
                 {TermKind::cross, 1.0 / base, c, a}},
                0.0, 0.0, std::max(chord, base), b);
        }
    }

    void add_area(std::size_t r) {
        const Region& region = *domain_.regions[r];
        const double area = areas_[r], size = std::sqrt(area);
        std::vector<Term> terms;
        for (std::size_t i = 0; i < region.border.size(); ++i) {
            terms.push_back({TermKind::cross, 0.5 / size, region.border[i] + domain_.first[r],
                             region.border[(i + 1) % region.border.size()] + domain_.first[r]});
        }
        add(std::move(terms), area / size * (1.0 + constraint().min_percent / 100.0),
            area / size * (1.0 + constraint().max_percent / 100.0), size,
            region.border.front() + domain_.first[r]);
    }

    void add_pin() {
        for (std::size_t r = 0; r < domain_.regions.size(); ++r) {
            const Region& region = *domain_.regions[r];
            if (!names(constraint().region, region.name)) continue;
            const auto& sources = region.source_vertices;
            const auto found = std::find(sources.begin(), sources.end(), constraint().vertex);
            if (found == sources.end()) continue;
            const Index v = static_cast<Index>(found - sources.begin()) + domain_.first[r];
            const double size = std::sqrt(areas_[r]);
            for (Index axis = 0; axis < 2; ++axis) {
                const double at = constraint().place[axis];
                add({{TermKind::coordinate, 1.0, v, axis}}, at, at, size, v);
            }
        }
    }

    const Domain& domain_;
    const std::vector<Constraint>& constraints_;
    std::vector<double> areas_;  ///< of the regions
    std::size_t current_ = 0;
    std::vector<ConstraintRow> rows_;
};

/// The edges of a row that fixes the sum of their lengths; none for other rows.
std::vector<Edge> fixed_edges(const ConstraintRow& row) {
    std::vector<Edge> edges;
    if (!row.is_equation()) return edges;
    for (const Term& term : row.terms) {
        if (term.kind != TermKind::length || term.factor != 1.0) return {};
        edges.push_back(std::minmax(term.a, term.b));
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

}  // namespace

double ConstraintRow::value(const Eigen::VectorXd& x) const {
    const Vec2 o = origin(x);
    double sum = 0.0;
    for (const Term& term : terms) {
        const Vec2 a = x.segment<2>(2 * term.a);
        switch (term.kind) {
            case TermKind::length:
                sum += term.factor * (a - x.segment<2>(2 * term.b)).norm();
                break;
            case TermKind::cross:
                sum += term.factor * cross(a - o, x.segment<2>(2 * term.b) - o);
                break;
            case TermKind::coordinate: sum += term.factor * a[term.b]; break;
        }
    }
    return sum;
}

double ConstraintRow::violation(double value) const {
    return value > most ? value - most : value < least ? value - least : 0.0;
}

std::vector<ConstraintRow> constraint_rows(const Domain& domain,
                                           const std::vector<Constraint>& constraints) {
    return RowBuilder(domain, constraints).run();
}

std::vector<std::size_t> distinct_rows(const std::vector<ConstraintRow>& rows,
                                       const std::vector<std::size_t>& chosen) {
    const auto same = [](double a, double b) {
        return std::abs(a - b) <= 1e-12 * std::max(std::abs(a), std::abs(b));
    };
    std::map<Edge, double> single;
    for (const std::size_t k : chosen) {
        const auto edges = fixed_edges(rows[k]);
        if (edges.size() == 1) single.emplace(edges.front(), rows[k].most);
    }
    std::map<std::vector<Edge>, double> seen;
    std::vector<std::size_t> distinct;
    for (const std::size_t k : chosen) {
        auto edges = fixed_edges(rows[k]);
        if (!edges.empty()) {
            double sum = 0.0;
            bool implied = edges.size() > 1;
            for (const Edge& edge : edges) {
                const auto found = single.find(edge);
                implied = implied && found != single.end();
                if (implied) sum += found->second;
            }
            if (implied && same(sum, rows[k].most)) continue;
            const auto [first, is_new] = seen.emplace(std::move(edges), rows[k].most);
            if (!is_new && same(first->second, rows[k].most)) continue;
        }
        distinct.push_back(k);
    }
    return distinct;
}

std::vector<std::vector<std::size_t>> coupled_regions(const std::vector<Region>& regions,
                                                      const std::vector<Constraint>& constraints) {
    std::vector<const Region*> all(regions.size());
    std::transform(regions.begin(), regions.end(), all.begin(),
                   [](const Region& region) { return &region; });
    DisjointSets sets(regions.size());
    for (const Constraint& constraint : constraints) {
        if (constraint.kind != ConstraintKind::match) continue;
        const Sides sides = match_sides(all, constraint);
        if (sides.size() != 2) {
            throw Error(ErrorCode::curve_invalid,
                        constraint.title() +
                            ": each side must be one stretch of a curve; name the regions that "
                            "they are in")
                .at_option(constraint.option);
        }
        sets.join(static_cast<Index>(sides[0].first), static_cast<Index>(sides[1].first));
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
