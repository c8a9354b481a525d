// Lengths that must be kept.
#pragma once

#include <string>
#include <vector>

#include "core/cut/region.h"

namespace lastflat {

enum class Keep {
    edges,  ///< every edge of the curve keeps its 3D length
    total,  ///< their sum does
};

struct Lock {
    std::string curve;
    Keep keep = Keep::edges;
};

/// The flat lengths of these edges add up to `length`, mm.
struct LengthConstraint {
    std::string curve;
    std::vector<std::pair<Index, Index>> edges;
    double length;
};

/// The constraints that the locks put on one region. An edge that two locks name is kept once; a
/// total whose edges are all kept already adds nothing.
[[nodiscard]] std::vector<LengthConstraint> length_constraints(const Region& region,
                                                               const std::vector<Lock>& locks);

/// Per border edge, whether a lock of kind `edges` holds it.
[[nodiscard]] std::vector<bool> locked_border_edges(const Region& region,
                                                    const std::vector<Lock>& locks);

/// Flat length of the constraint's edges, mm.
[[nodiscard]] double flat_length(const LengthConstraint& constraint, const Eigen::VectorXd& x);

}  // namespace lastflat
