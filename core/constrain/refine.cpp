#include "core/constrain/refine.h"

#include "core/constrain/distortion_weights.h"
#include "core/constrain/scale_to_locks.h"

namespace lastflat {
namespace {

/// Calls with what `isometric` demands of a domain.
template <class Call>
auto with_demands(const Domain& domain, const Request& request,
                  const std::vector<Constraint>& constraints, const Call& call) {
    const DistortionWeights& asked = request.weights;
    std::vector<std::vector<double>> weights;
    for (const Region* region : domain.regions)
        weights.push_back(triangle_weights(*region, asked.zones));
    const SymmetricDirichlet even;
    const WeightedDirichlet uneven(asked.stretch, asked.compression);
    const IsotropicEnergy& energy =
        asked.even() ? static_cast<const IsotropicEnergy&>(even) : uneven;
    return call(Demands{constraints, energy, std::move(weights), request.on_conflict, true});
}

ConstrainedChart least_energy(const Domain& domain, const std::vector<Chart>& starts,
                              const IsotropicEnergy& energy, std::size_t threads,
                              const Progress& progress) {
    const std::vector<Constraint> none;
    return least_distortion(domain, starts, {none, energy}, threads, progress);
}

/// A method without a scale of its own.
ConstrainedChart scaled(const Domain& domain, ConstrainedChart result,
                        const std::vector<Constraint>& constraints) {
    for (std::size_t r = 0; r < domain.regions.size(); ++r) {
        Chart& chart = result.minimum.charts[r];
        chart = scaled_to_locks(*domain.regions[r], std::move(chart), constraints);
    }
    return result;
}

}  // namespace

ConstrainedChart refine(const Domain& domain, std::vector<Chart> starts, const Request& request,
                        const std::vector<Constraint>& constraints, std::size_t threads,
                        const Progress& progress, Warmth* left) {
    switch (request.method.name) {
        case MethodName::isometric:
            return with_demands(domain, request, constraints, [&](const Demands& demands) {
                return least_distortion(domain, starts, demands, threads, progress, left);
            });
        case MethodName::green_lagrange:
            return least_energy(domain, starts, GreenLagrange(), threads, progress);
        case MethodName::mips:
            return scaled(domain, least_energy(domain, starts, Mips(), threads, progress),
                          constraints);
        case MethodName::tutte:
        case MethodName::chord_length:
        case MethodName::shape_preserving:
        case MethodName::harmonic:
        case MethodName::wachspress:
        case MethodName::mean_value:
        case MethodName::virtual_border:
        case MethodName::geodesic_fan: break;
    }
    ConstrainedChart start;
    start.minimum.charts = std::move(starts);
    return scaled(domain, std::move(start), constraints);
}

std::optional<ConstrainedChart> refine_again(const Domain& domain, const Request& request,
                                             const std::vector<Constraint>& constraints,
                                             std::size_t threads, const Progress& progress,
                                             Warmth& warmth) {
    if (request.method.name != MethodName::isometric) return std::nullopt;
    return with_demands(domain, request, constraints, [&](const Demands& demands) {
        return least_distortion_again(domain, demands, threads, progress, warmth);
    });
}

void refresh(const Domain& domain, const Request& request,
             const std::vector<Constraint>& constraints, std::size_t threads,
             const Progress& progress, Warmth& warmth) {
    with_demands(domain, request, constraints, [&](const Demands& demands) {
        refresh(domain, demands, threads, progress, warmth);
    });
}

}  // namespace lastflat
