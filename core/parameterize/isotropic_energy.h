// Energies of a triangle that depend on its singular values alone: value, gradient, Hessian.
#pragma once

namespace lastflat {

/// An energy density at singular values s1 >= s2 of the map surface -> plane, with the four numbers
/// that make up its Hessian with respect to that map: a 2x2 matrix for the two stretches, and the
/// eigenvalues of the in-plane twist and of the flip.
///
/// Paper: [smith-2019], section 4 (2D): twist (d1 + d2) / (s1 + s2), flip (d1 - d2) / (s1 - s2).
struct EnergyDerivatives {
    double value;
    double d1, d2;
    double d11, d12, d22;
    double twist, flip;
};

class IsotropicEnergy {
public:
    virtual ~IsotropicEnergy() = default;
    /// Only called with s2 > 0: a triangle that has flipped has infinite energy.
    [[nodiscard]] virtual double value(double s1, double s2) const = 0;
    [[nodiscard]] virtual EnergyDerivatives derivatives(double s1, double s2) const = 0;
};

/// (s1^2 + s2^2 + s1^-2 + s2^-2) / 4: one for an isometry, infinite for a collapse.
///
/// Paper: [smith-2015], section 3; here divided by four.
class SymmetricDirichlet final : public IsotropicEnergy {
public:
    [[nodiscard]] double value(double s1, double s2) const override;
    [[nodiscard]] EnergyDerivatives derivatives(double s1, double s2) const override;
};

}  // namespace lastflat
