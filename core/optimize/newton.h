// Least energy under rows.
#pragma once

#include "core/numerics/tolerances.h"
#include "core/optimize/optimality_system.h"
#include "core/parameterize/chart.h"

namespace lastflat {

/// A map of a greater mean density is far from any isometry.
inline constexpr double near_isometry = 1.05;

/// When a search may end before its minimum.
struct Approach {
    double enough = 0.0;    ///< mean density below which it does
    double decrease = 0.0;  ///< share of the distortion below which a step promises too little
    /// At most so much is left of the first-order conditions, see `Minimum`.
    double projected_gradient = tolerance::projected_gradient, error = tolerance::solver_length;
};

struct Minimum {
    std::vector<Chart> charts;        ///< one per region
    Eigen::VectorXd multipliers;      ///< per row, mm
    int iterations = 0;               ///< Newton steps
    double energy = 0.0;              ///< mean density over the surface
    double projected_gradient = 0.0;  ///< of the mean density, per mm of a point's way, times the
                                      ///< square root of the area: no unit
    double worst_error = 0.0;  ///< of a row that is kept exactly, as a share of its reference
    bool converged = false;
    bool contradictory = false;  ///< it ended because the rows seem to contradict each other
    Eigen::VectorXd errors;      ///< per row, mm
};

/// Minimises distortion and other terms subject to rows: sequential quadratic programming with
/// projected Newton Hessians, exact ones near the end, steps that flip no triangle,
/// and a line search on the energy plus the weighted errors of the rows.
///
/// Paper:  [smith-2015], [smith-2019]; the multipliers' system: [vanderbei-1995]; the merit
///         function and second-order correction: [nocedal-2006], chapters 15 and 18.
/// In:     coordinates at which the energy is finite, with a multiplier per row: zero, or what a
///         search before has left; a new system, or one that a problem of the same pattern has
///         left: as long as its factor leads nearer, no other is made.
/// Out:    charts without flipped triangles. Converged: projected gradient and errors are at most
///         the approach's; or no step lowers the energy and the gradient is at most
///         `tolerance::stalled_gradient` or what the rounding of the coordinates makes of it
///         (needles), errors likewise; or the approach has come near enough. One answer for one
///         input, whatever the number of threads.
/// Throws: Error{solver_failed}; Error{canceled}.
[[nodiscard]] Minimum minimise(const Problem& problem, const Iterate& start,
                               const Approach& approach, OptimalitySystem& system,
                               const Progress& progress);

}  // namespace lastflat
