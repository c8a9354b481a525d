// Based on: Smith, de Goes, Kim, "Analytic Eigensystems for Isotropic Distortion Energies", TOG
// 2019; Smith, Schaefer, "Bijective Parameterization with Free Boundaries", SIGGRAPH 2015; Hormann,
// Greiner, "MIPS: An Efficient Global Parametrization Method", 2000; Maillot, Yahia, Verroust,
// "Interactive Texture Mapping", SIGGRAPH 1993.
#include "core/optimize/isotropic_energy.h"

#include <cmath>

#include "core/numerics/tolerances.h"

namespace lastflat {

double SymmetricDirichlet::value(double s1, double s2) const {
    return 0.25 * (s1 * s1 + s2 * s2 + 1.0 / (s1 * s1) + 1.0 / (s2 * s2));
}

EnergyDerivatives SymmetricDirichlet::derivatives(double s1, double s2) const {
    const double i1 = 1.0 / s1, i2 = 1.0 / s2;
    const double product = i1 * i1 * i1 * i2 * i2 * i2;
    EnergyDerivatives e{};
    e.value = value(s1, s2);
    e.d1 = 0.5 * (s1 - i1 * i1 * i1);
    e.d2 = 0.5 * (s2 - i2 * i2 * i2);
    e.d11 = 0.5 * (1.0 + 3.0 * i1 * i1 * i1 * i1);
    e.d12 = 0.0;
    e.d22 = 0.5 * (1.0 + 3.0 * i2 * i2 * i2 * i2);
    // The differences are divided out, so that s1 = s2 needs no limit.
    e.twist = 0.5 * (1.0 - (s1 * s1 - s1 * s2 + s2 * s2) * product);
    e.flip = 0.5 * (1.0 + (s1 * s1 + s1 * s2 + s2 * s2) * product);
    return e;
}

/// w f with f = (s^2 + s^-2 - 2) / 4, which is zero at s = 1, and w between the two weights.
WeightedDirichlet::Density WeightedDirichlet::density(double s) const {
    constexpr double width = 2e-3;
    const double i = 1.0 / s;
    const double f = 0.25 * (s - i) * (s - i);
    const double f1 = 0.5 * (s - i * i * i), f2 = 0.5 * (1.0 + 3.0 * i * i * i * i);
    const double t = std::tanh((s - 1.0) / width), slope = (1.0 - t * t) / width;
    const double w = mean_ + half_ * t, w1 = half_ * slope, w2 = -2.0 * half_ * t * slope / width;
    return {w * f, w1 * f + w * f1, w2 * f + 2.0 * w1 * f1 + w * f2};
}

double WeightedDirichlet::value(double s1, double s2) const {
    return 1.0 + density(s1).value + density(s2).value;
}

EnergyDerivatives WeightedDirichlet::derivatives(double s1, double s2) const {
    const Density a = density(s1), b = density(s2);
    EnergyDerivatives e{};
    e.value = 1.0 + a.value + b.value;
    e.d1 = a.first;
    e.d2 = b.first;
    e.d11 = a.second;
    e.d12 = 0.0;
    e.d22 = b.second;
    e.twist = (e.d1 + e.d2) / (s1 + s2);
    e.flip =
        s1 - s2 > tolerance::equal_stretches ? (e.d1 - e.d2) / (s1 - s2) : 0.5 * (e.d11 + e.d22);
    return e;
}

double Mips::value(double s1, double s2) const {
    return 0.5 * (s1 / s2 + s2 / s1);
}

EnergyDerivatives Mips::derivatives(double s1, double s2) const {
    const double i1 = 1.0 / s1, i2 = 1.0 / s2;
    EnergyDerivatives e{};
    e.value = value(s1, s2);
    e.d1 = 0.5 * (i2 - s2 * i1 * i1);
    e.d2 = 0.5 * (i1 - s1 * i2 * i2);
    e.d11 = s2 * i1 * i1 * i1;
    e.d12 = -0.5 * (i1 * i1 + i2 * i2);
    e.d22 = s1 * i2 * i2 * i2;
    e.twist = -0.5 * (s1 - s2) * (s1 - s2) * i1 * i1 * i2 * i2;
    e.flip = 0.5 * (s1 + s2) * (s1 + s2) * i1 * i1 * i2 * i2;
    return e;
}

double GreenLagrange::value(double s1, double s2) const {
    const double e1 = s1 * s1 - 1.0, e2 = s2 * s2 - 1.0;
    return 1.0 + 0.25 * (e1 * e1 + e2 * e2);
}

EnergyDerivatives GreenLagrange::derivatives(double s1, double s2) const {
    EnergyDerivatives e{};
    e.value = value(s1, s2);
    e.d1 = s1 * (s1 * s1 - 1.0);
    e.d2 = s2 * (s2 * s2 - 1.0);
    e.d11 = 3.0 * s1 * s1 - 1.0;
    e.d12 = 0.0;
    e.d22 = 3.0 * s2 * s2 - 1.0;
    e.twist = s1 * s1 - s1 * s2 + s2 * s2 - 1.0;
    e.flip = s1 * s1 + s1 * s2 + s2 * s2 - 1.0;
    return e;
}

}  // namespace lastflat
