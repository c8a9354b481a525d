// Where groups of faces meet.
#pragma once

#include "core/locate/curves.h"

namespace lastflat {

/// One group: the line between its faces and all others, or the border; two: the line where they
/// meet. Vertices in order; closed lines begin and end at their smallest id.
/// Throws: Error{group_not_found}; Error{curve_invalid} if there is no such line, more than one, or
///         if it branches.
[[nodiscard]] std::vector<Index> group_line(const SurfaceMesh& surface, const std::string& curve,
                                            const GroupBorder& border);

}  // namespace lastflat
