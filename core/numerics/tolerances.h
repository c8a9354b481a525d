// Every epsilon of core, each with its reason: what is round-off, and what is near enough to be the
// same. All are relative unless the name says otherwise. What is judged, what a last looks like,
// and the parameters of a method (shares, penalties, counts) stand where that is done.
#pragma once

namespace lastflat::tolerance {

/// A triangle whose smallest height is below this share of its longest edge has no usable shape:
/// cotangents and rest frames lose most digits, and Newton's method the rest.
inline constexpr double degenerate_height = 1e-6;

/// The same of a triangle that fills the rim of a feature: a rim has the vertices that it has, and
/// the optimiser bears needles, but none without any height.
inline constexpr double filling_height = 1e-9;

/// Vertices nearer to each other than this share of the model's size are one: the digits of a
/// float.
inline constexpr double same_position = 1e-6;
/// Borders nearer than this share of the model's size may be one line, which two programs have
/// divided each in its own way: about 0.6 mm on a last. Vertices nearer than this share of that
/// were one from the start.
inline constexpr double near_border = 2e-3, same_border_vertex = 1e-3;
/// A vertex that comes to lie nearer to another than this share of the edges there would make a
/// needle.
inline constexpr double needle = 0.25;
/// Two loops that run along each other differ in length by less than this share of it, and in how
/// often they go round by less than this of a turn.
inline constexpr double alike_length = 0.05, alike_turns = 0.01;
/// A loose piece of less than this share of the largest one's area is a stray.
inline constexpr double stray_area = 0.01;

/// A hole no further across than this and than this share of the surface's size, in a surface that
/// is closed but for such, is a fault of the file or the scan, or a jack pin.
inline constexpr double small_hole_mm = 20.0, small_hole = 0.2;

/// Coordinates beyond this many mm are no last, and their squares soon are no numbers.
inline constexpr double largest_coordinate_mm = 1e6;

/// A locked length that is off by more than this share of itself has not been kept
/// (design: pass at 1e-6). The solver aims at `solver_length`.
inline constexpr double locked_length = 1e-6;
inline constexpr double solver_length = 1e-10;

/// Newton's method has converged when the projected gradient (see `Minimum`) is below this; its
/// round-off is about 1e-14.
inline constexpr double projected_gradient = 1e-9;
/// In a live session somebody waits for the last steps, and sees nothing of them: with these left a
/// point is within 1e-5 mm of its place, and a locked length still a hundred times as near as
/// asked.
inline constexpr double live_gradient = 1e-8, live_length = 1e-8;
/// Where no step lowers the energy any more round-off hides the rest (needles, circles shrunk to
/// points); above this it was not round-off.
inline constexpr double stalled_gradient = 1e-7;
/// Below this sum of projected gradient and error the first-order conditions are solved directly.
inline constexpr double nearly_optimal = 1e-3;
/// The merit function may rise by this share of itself, which is its round-off, at each step; a
/// step that promises to lower it by less than the second share is idle; one shorter than the third
/// share of Newton's goes nowhere.
inline constexpr double merit_round_off = 1e-13, idle_decrease = 1e-15, smallest_step = 1e-10;
/// A linear system is solved when the residual is this share of the right side; where an old factor
/// corrects what is left, and leaves a hundredth at best, the second share will do.
inline constexpr double refined = 1e-12, roughly_refined = 1e-6;
/// Two principal stretches nearer to each other than this are equal: the quotient of differences
/// would be round-off, and is its limit to ten digits.
inline constexpr double equal_stretches = 1e-6;
/// A quadratic coefficient below this share of the linear one is 0.
inline constexpr double linear = 1e-14;

/// A border vertex that passes the end of an edge by less than this share of it meets the edge.
inline constexpr double passed_corner = 1e-6;
/// Border edges nearer on the last than this share of the clearance are two sides of one curve.
inline constexpr double slit_width = 1e-3;

/// An equation whose sum, after what others say is taken out, is below this share of its terms
/// says nothing new.
inline constexpr double dependent_row = 1e-12;
/// Radians: locked edges around a vertex whose angles miss a full turn by less close.
inline constexpr double full_turn = 10.0 * locked_length;

/// Added to the diagonal of a Hessian, as a share of its median: a rigid motion costs no energy, so
/// the Hessian alone is singular in three directions. The least of the shifts that are tried.
inline constexpr double rigid_motion = 1e-9;

/// Added to the diagonal of the three coordinates that hold a chart still, as a multiple of the
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

/// How far a drawn point may be from the surface, how near to another curve or to the border the
/// end of a drawn curve must be to be put on it, and how far a position may be from the border loop
/// that it means, as shares of the surface's size: about 6, 1.2 and 30 mm on a last, so that the
/// middle of a hole means the hole.
inline constexpr double drawn_reach = 0.02, drawn_end_reach = 0.004, border_reach = 0.1;

/// Barycentric weights, and shares of an edge, below this are 0: what is on an edge but for
/// round-off is on it, else a line would lose its way there.
inline constexpr double on_edge = 1e-9;
/// The same for weights that a linear system of three has given.
inline constexpr double solved_weight = 1e-12;

/// Radians. Of border loops that turn alike to this much none is the outer one by its turning.
inline constexpr double alike_turning = 0.01;

/// Radians: a polygon that turns by less has no corner there; angles beyond the second are taken
/// for it, because the tangent of their half soon is infinite; the third is what is left to a
/// border vertex in the flat, where the border turns by more than pi.
inline constexpr double corner = 1e-9, widest_angle = 3.1, least_border_angle = 1e-3;

/// Edges of which the determinant of their Gram matrix is below this share of its bound are
/// parallel: a polygon cannot be closed by changing them.
inline constexpr double parallel = 1e-12;

/// A capacity below this share of all that a flow can carry is used up.
inline constexpr double used_up = 1e-12;

/// Percent: a strain below this is round-off.
inline constexpr double noticed_strain_percent = 1e-6;

/// Geodesics: differences below this share are round-off.
inline constexpr double geodesic_round_off = 1e-12;

/// A ray that misses a corner by less than this share of its length and the triangle's size meets
/// it: what unfolding thousands of triangles in a row adds up to. The length of a path around the
/// corner is off by the square of it.
inline constexpr double geodesic_ray = 1e-11;
/// Paths that cross an edge nearer to its end than this share of it go over the end, windows that
/// a corner splits nearer to each other are not compared, and what is to be passed over must be
/// longer by so much of the edge.
inline constexpr double geodesic_slack = 1e-8;
/// Radians: paths go on straight over a vertex to this much; less than `geodesic_ray`, so that what
/// shines past the next vertex in line ends there.
inline constexpr double geodesic_margin = 1e-12;
/// A root nearer to a corner than this share of the triangle is that corner: others are further.
inline constexpr double geodesic_corner = 1e-6;

/// Two sides of a cut may differ by this much in the flat, in mm (design: pass at 0.001 mm).
inline constexpr double pair_difference_mm = 1e-3;

}  // namespace lastflat::tolerance
