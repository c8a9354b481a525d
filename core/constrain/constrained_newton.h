// Least distortion under exact lengths.
#pragma once

#include "core/constrain/length_constraints.h"
#include "core/parameterize/chart.h"
#include "core/parameterize/isotropic_energy.h"
#include "core/progress.h"

namespace lastflat {

struct Minimum {
    Chart chart;
    int iterations = 0;               ///< Newton steps, approach and locked phase together
    double energy = 0.0;              ///< mean density over the surface
    double worst_length_error = 0.0;  ///< of a constraint, as a share of its length
    std::vector<Warning> warnings{};
};

/// Minimises the distortion of a chart subject to the length constraints: sequential quadratic
/// programming with projected Newton Hessians, exact ones near the end, a step that no triangle
/// survives flipped, and a line search on the energy plus the weighted constraint errors.
///
/// Paper:  [smith-2015], [smith-2019]; the multipliers' system: [vanderbei-1995]; the merit
///         function and second-order correction: [nocedal-2006], chapters 15 and 18.
/// In:     a start without flipped triangles; scale does not matter.
/// Out:    a local minimum without flipped triangles: the step still promised decreases the energy
///         by less than `tolerance::newton_decrease`, every length is kept to
///         `tolerance::solver_length`. Where that is out of reach (needles, very slender shapes), a
///         chart without flips and with every length kept to `tolerance::locked_length`, and the
///         warning `not_converged`. One answer for one input, whatever the number of threads.
/// Throws: Error{method_failed} if the start is folded; Error{constraints_infeasible} naming the
///         worst curve if the lengths cannot all be reached; Error{solver_failed};
///         Error{cancelled}.
[[nodiscard]] Minimum minimise_distortion(const Region& region, const Chart& start,
                                          const std::vector<LengthConstraint>& constraints,
                                          const IsotropicEnergy& energy, const Progress& progress);

}  // namespace lastflat
