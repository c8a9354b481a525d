// The unit of a model whose maker does not say.
#pragma once

#include <optional>

#include "core/error.h"
#include "core/load/raw_mesh.h"
#include "core/request.h"

namespace lastflat {

/// A last is 150 to 350 mm long.
inline constexpr double shortest_last_mm = 150.0, longest_last_mm = 350.0;
/// An infant's is 107.
inline constexpr double shortest_infant_mm = 95.0;
/// A model of fewer triangles is a test piece, not a last: its unit is not guessed.
inline constexpr std::size_t fewest_triangles_of_a_last = 100;

struct UnitGuess {
    double unit_mm;
    std::optional<Warning> warning;  ///< what was assumed, unless the format's own unit fits
};

/// The unit that the options give, with the warning `size_unusual` where no last is so large or
/// small. Else, if they say how long the last is, the unit of mm, cm, m and in that makes it so
/// long to a hundredth, or that which makes it exactly so long. Else the format's unit if the model
/// then is as long as a last; else the first of mm, cm, m and in with which it is; else the
/// format's, with a warning.
///
/// Throws: Error{unsupported_request} if unit and length contradict each other by more than 5 %.
[[nodiscard]] UnitGuess unit_of(const RawMesh& raw, const WeldOptions& options);

}  // namespace lastflat
