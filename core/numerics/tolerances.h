// Every epsilon of core, each with its reason. All are relative unless the name says otherwise.
#pragma once

namespace lastflat::tolerance {

/// A triangle whose smallest height is below this share of its longest edge has no usable shape:
/// cotangents and rest frames lose most digits, and Newton's method the rest.
inline constexpr double degenerate_height = 1e-6;

/// Coordinates beyond this many mm are no last, and their squares soon are no numbers.
inline constexpr double largest_coordinate_mm = 1e6;

/// A locked length that is off by more than this share of itself has not been kept
/// (design: pass at 1e-6). The solver aims at `solver_length`.
inline constexpr double locked_length = 1e-6;
inline constexpr double solver_length = 1e-10;

/// Newton's method has converged when the projected gradient (see `Minimum`) is below this; its
/// round-off is about 1e-14.
inline constexpr double projected_gradient = 1e-9;
/// Where no step lowers the energy any more round-off hides the rest (needles, circles shrunk to
/// points); above this it was not round-off.
inline constexpr double stalled_gradient = 1e-7;

/// Added to the diagonal of a Hessian, as a share of its mean: a rigid motion costs no energy, so
/// the Hessian alone is singular in three directions. The least of the shifts that are tried.
inline constexpr double rigid_motion = 1e-9;

/// Added to the diagonal of the three coordinates that hold a chart in place, as a multiple of the
/// mean: large enough to hold them, small enough to keep the others' digits.
inline constexpr double pin = 1e4;

/// Subtracted from the diagonal of the multipliers, so that the optimality system is
/// quasi-definite and can be factored in any order (Vanderbei 1995). Refinement removes its trace.
inline constexpr double multiplier_regularisation = 1e-7;

/// A curve that is put into a face is put on a vertex or an edge that it passes nearer than this
/// share of the face's longest edge. A shortest path's length is off by the square of it, and a
/// triangle of this height has shape enough (see `degenerate_height`); what a hand has drawn is not
/// exact anyway, and moves further rather than make needles.
inline constexpr double geodesic_snap = 1e-4, drawn_snap = 0.05;

/// Geodesics: differences below this share are round-off.
inline constexpr double geodesic_round_off = 1e-12;

/// Light through an edge: what misses an end by less than this share of the edge still reaches it,
/// so that no ray is lost between two windows; the length of its path is off by the square of it.
inline constexpr double geodesic_slack = 1e-8;

/// Two sides of a cut may differ by this much in the flat, in mm (design: pass at 0.001 mm).
inline constexpr double pair_difference_mm = 1e-3;

}  // namespace lastflat::tolerance
