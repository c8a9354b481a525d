// Constraints as functions of the flat points.
#pragma once

#include "core/constrain/constraint.h"
#include "core/parameterize/domain.h"

namespace lastflat {

enum class TermKind {
    length,      ///< |x_a - x_b|
    cross,       ///< x_a cross x_b, mm^2
    coordinate,  ///< coordinate b (0 or 1) of x_a
};

struct Term {
    TermKind kind;
    double factor;
    Index a, b;
};

/// The sum of the terms shall lie between `least` and `most`, mm.
struct ConstraintRow {
    std::size_t constraint;  ///< its place in the list of constraints
    std::vector<Term> terms;
    double least, most;
    double reference;  ///< mm, what its error is a share of
    Index vertex;      ///< where it is on the last

    /// Cross products are taken from here, near the row's points, so that they keep their digits
    /// wherever the chart lies; their sum around a polygon is the same from everywhere.
    [[nodiscard]] Vec2 origin(const Eigen::VectorXd& x) const { return x.segment<2>(2 * vertex); }

    [[nodiscard]] double value(const Eigen::VectorXd& x) const;
    /// What is missing, with its sign: above `most` positive, below `least` negative, else zero.
    [[nodiscard]] double violation(double value) const;
    [[nodiscard]] bool is_equation() const { return least == most; }
};

/// The rows that the constraints put on a domain. A match binds the domain that has both its sides.
[[nodiscard]] std::vector<ConstraintRow> constraint_rows(
    const Domain& domain, const std::vector<Constraint>& constraints);

/// Of the chosen rows those that say something new, ascending: an edge that two of them lock is
/// locked once; a sum or a difference of lengths that follows from others adds nothing.
[[nodiscard]] std::vector<std::size_t> distinct_rows(const std::vector<ConstraintRow>& rows,
                                                     const std::vector<std::size_t>& chosen);

/// Which regions have to be flattened together because constraints match their curves or sew them:
/// groups of places in `regions`, ascending.
/// Throws: Error{curve_invalid} if a match names no two sides, or a seam has them nowhere.
[[nodiscard]] std::vector<std::vector<std::size_t>> coupled_regions(
    const std::vector<Region>& regions, const std::vector<Constraint>& constraints);

}  // namespace lastflat
