// What happens when constraints cannot all hold.
#pragma once

#include "core/constrain/minimise_distortion.h"
#include "core/constrain/warmth.h"
#include "core/error.h"
#include "core/request.h"

namespace lastflat {

struct ConstrainedChart {
    Minimum minimum;
    std::vector<std::size_t> relaxed;  ///< constraints that gave way
    std::vector<Warning> warnings;
};

/// What is asked of a domain.
struct Demands {
    const std::vector<Constraint>& constraints;
    const IsotropicEnergy& energy;
    std::vector<std::vector<double>> weights{};  ///< see `Distortion`
    OnConflict on_conflict = OnConflict::fail;
    bool contact = false;  ///< borders are kept from crossing themselves; no start may cross
};

/// Least distortion of a domain under constraints. Curves that are locked by edges are stiff (see
/// `WireStiffness`).
///
/// Out:    every constraint kept to `tolerance::locked_length` but the relaxed ones, of which the
///         least important one of every set that fights gave way; it still pulls, with at most a
///         tenth of the size of the surface, so that it does not distort the rest beyond measure.
///         Warning `not_converged` if the minimum was not reached (needles, slender shapes).
/// Throws: Error{method_failed} if the constraints were not reached although nothing shows that
///         they contradict each other (stuck in contact); Error{constraints_infeasible} with the
///         smallest set found of constraints that fight: no member of it can be left out; how far
///         each is off at the best compromise, and where. Others as `minimise_distortion`.
/// `left`: if not null, takes what stays warm; empty if constraints gave way or the minimum was not
///         reached.
[[nodiscard]] ConstrainedChart least_distortion(const Domain& domain,
                                                const std::vector<Chart>& starts,
                                                const Demands& demands, std::size_t threads,
                                                const Progress& progress, Warmth* left = nullptr);

/// The same from where a solve of the same domain ended, for demands that may be others. Nothing if
/// that does not lead to an optimum that keeps every constraint; the warmth is then as good as it
/// was.
/// Where no border comes into contact it is the optimum that `least_distortion` finds.
/// Throws: Error{solver_failed}; Error{canceled}, likewise.
[[nodiscard]] std::optional<ConstrainedChart> least_distortion_again(const Domain& domain,
                                                                     const Demands& demands,
                                                                     std::size_t threads,
                                                                     const Progress& progress,
                                                                     Warmth& warmth);

/// Makes the factor anew where the solve with these demands ended: the next one then begins with
/// the best that there is.
/// Throws: Error{canceled}; the warmth then has the factor that it had.
void refresh(const Domain& domain, const Demands& demands, std::size_t threads,
             const Progress& progress, Warmth& warmth);

}  // namespace lastflat
