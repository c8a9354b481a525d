// The unit of a model whose maker does not say.
#pragma once

#include <optional>

#include "core/error.h"
#include "core/load/raw_mesh.h"

namespace lastflat {

/// A last is 150 to 350 mm long.
inline constexpr double shortest_last_mm = 150.0, longest_last_mm = 350.0;
/// A model of fewer triangles is a test piece, not a last: its unit is not guessed.
inline constexpr std::size_t fewest_triangles_of_a_last = 100;

struct UnitGuess {
    double unit_mm;
    std::optional<Warning> warning;  ///< what was assumed, unless the format's own unit fits
};

/// The format's unit if the model then is as long as a last; else the first of mm, cm, m and in
/// with which it is; else the format's, with a warning.
[[nodiscard]] UnitGuess guess_unit(const RawMesh& raw);

}  // namespace lastflat
