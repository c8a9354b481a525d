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
    /// Whether a uniform scale of the plane changes nothing.
    [[nodiscard]] virtual bool scale_free() const { return false; }
};

/// (s1^2 + s2^2 + s1^-2 + s2^-2) / 4: one for an isometry, infinite for a collapse.
///
/// Paper: [smith-2015], section 3; here divided by four.
class SymmetricDirichlet final : public IsotropicEnergy {
public:
    [[nodiscard]] double value(double s1, double s2) const override;
    [[nodiscard]] EnergyDerivatives derivatives(double s1, double s2) const override;
};

/// The symmetric Dirichlet energy with two weights: where the map shrinks (s < 1) the leather will
/// be stretched on the last, where it grows (s > 1) compressed. Between them, within some tenths of
/// a per cent of s = 1, the weight changes smoothly, so that there is a Hessian everywhere.
class WeightedDirichlet final : public IsotropicEnergy {
public:
    WeightedDirichlet(double stretch, double compression)
        : mean_(0.5 * (stretch + compression)), half_(0.5 * (compression - stretch)) {}
    [[nodiscard]] double value(double s1, double s2) const override;
    [[nodiscard]] EnergyDerivatives derivatives(double s1, double s2) const override;

private:
    struct Density {
        double value, first, second;
    };
    [[nodiscard]] Density density(double s) const;

    double mean_, half_;
};

/// (s1 / s2 + s2 / s1) / 2: one for a similarity, infinite for a collapse.
///
/// Paper: [hormann-2000], section 3; here divided by two and weighed by the surface's area, so that
/// the sum does not depend on how finely the surface is triangulated.
class Mips final : public IsotropicEnergy {
public:
    [[nodiscard]] double value(double s1, double s2) const override;
    [[nodiscard]] EnergyDerivatives derivatives(double s1, double s2) const override;
    [[nodiscard]] bool scale_free() const override { return true; }
};

/// 1 + ((s1^2 - 1)^2 + (s2^2 - 1)^2) / 4: one for an isometry, and near it like the symmetric
/// Dirichlet energy; finite for a collapse, which it does not prevent.
///
/// Paper: [maillot-1993], section 3: the norm of the Green-Lagrange tensor.
class GreenLagrange final : public IsotropicEnergy {
public:
    [[nodiscard]] double value(double s1, double s2) const override;
    [[nodiscard]] EnergyDerivatives derivatives(double s1, double s2) const override;
};

}  // namespace lastflat
