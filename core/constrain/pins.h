// Points that lie at given positions in the plane.
#pragma once

#include "core/constrain/constraint.h"
#include "core/optimize/domain.h"

namespace lastflat {

struct PinnedVertex {
    Index vertex;  ///< of the region
    Vec2 at;       ///< mm
};

/// The vertices of a region that a pin binds: one as a rule, several on a cut.
[[nodiscard]] std::vector<PinnedVertex> pinned_vertices(const Region& region, const Pin& pin);

/// The pins of one region.
[[nodiscard]] std::vector<PinnedVertex> pinned_vertices(const Region& region,
                                                        const std::vector<Constraint>& constraints);

/// Moves and turns points rigidly so that the pinned ones come as near to their positions as they
/// can.
///
/// Paper: [umeyama-1991], in the plane.
void move_to_pins(const std::vector<PinnedVertex>& pins, Points2& uv);

}  // namespace lastflat
