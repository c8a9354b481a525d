// Least distortion under exact constraints.
#pragma once

#include "core/constrain/constraint_rows.h"
#include "core/constrain/stiff_curves.h"
#include "core/error.h"
#include "core/parameterize/isotropic_energy.h"
#include "core/progress.h"

namespace lastflat {

/// Minimise what, under which rows.
struct Problem {
    const Domain& domain;
    const std::vector<ConstraintRow>& rows;
    const IsotropicEnergy& energy;
    /// Per row, mm of error for a force of 1 mm; 0 or absent: the row is kept exactly.
    std::vector<double> compliance{};
    std::size_t threads = 1;
    /// Whether borders are kept from crossing themselves. The starts must not cross.
    bool contact = false;
    /// Of curves that are to stay smooth; may be null.
    const StiffCurves* stiff_curves = nullptr;
    /// Per region and triangle how much its distortion counts; none: all the same.
    std::vector<std::vector<double>> weights{};
};

struct Minimum {
    std::vector<Chart> charts;  ///< one per region
    int iterations = 0;         ///< Newton steps, approach and constrained phase together
    int factorizations = 0;
    double energy = 0.0;              ///< mean density over the surface
    double projected_gradient = 0.0;  ///< of the mean density, per mm of a point's way, times the
                                      ///< square root of the area: no unit
    double worst_error = 0.0;  ///< of a row that is kept exactly, as a share of its reference
    bool converged = false;
    bool contradictory = false;  ///< it ended because the constraints seem to contradict each other
    Eigen::VectorXd errors;      ///< per row, mm
};

/// Minimises the distortion of charts subject to constraints: sequential quadratic programming with
/// projected Newton Hessians, exact ones near the end, a step that no triangle survives flipped,
/// and a line search on the energy plus the weighted constraint errors. Inequalities are held or
/// let go by the sign of their multiplier.
///
/// Paper:  [smith-2015], [smith-2019]; the multipliers' system: [vanderbei-1995]; the merit
///         function and second-order correction: [nocedal-2006], chapters 15 and 18; the active
///         set: [hintermueller-2002].
/// In:     starts without flipped triangles; scale does not matter.
/// Out:    charts without flipped triangles. Converged: the projected gradient is at most
///         `tolerance::projected_gradient` and every error at most `tolerance::solver_length`, or
///         no step lowers the energy and the gradient is at most `tolerance::stalled_gradient`. One
///         answer for one input, whatever the number of threads.
/// Throws: Error{method_failed} if a start is folded; Error{solver_failed}; Error{cancelled}.
[[nodiscard]] Minimum minimise_distortion(const Problem& problem, const std::vector<Chart>& starts,
                                          const Progress& progress);

}  // namespace lastflat
