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

    [[nodiscard]] double value(const Eigen::VectorXd& x) const;
};

/// The sum of the terms shall lie between `least` and `most`, mm.
struct ConstraintRow {
    std::size_t constraint;  ///< its place in the list of constraints
    std::vector<Term> terms;
    double least, most;
    double reference;  ///< mm, what its error is a share of
    Index vertex;      ///< where it is on the last

    [[nodiscard]] double value(const Eigen::VectorXd& x) const;
    /// What is missing, with its sign: above `most` positive, below `least` negative, else zero.
    [[nodiscard]] double violation(double value) const;
    [[nodiscard]] bool is_equation() const { return least == most; }
};

/// The rows that the constraints put on a domain. An edge that two locks name is locked once; a
/// total whose edges are all locked adds nothing. A match binds the domain that has both its sides.
[[nodiscard]] std::vector<ConstraintRow> constraint_rows(
    const Domain& domain, const std::vector<Constraint>& constraints);

/// Which regions have to be flattened together because constraints match their curves: groups of
/// places in `regions`, ascending.
/// Throws: Error{curve_invalid} if a match names no two sides.
[[nodiscard]] std::vector<std::vector<std::size_t>> coupled_regions(
    const std::vector<Region>& regions, const std::vector<Constraint>& constraints);

}  // namespace lastflat
