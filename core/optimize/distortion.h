// The distortion of whole charts.
#pragma once

#include "core/optimize/domain.h"
#include "core/optimize/energy_term.h"
#include "core/optimize/isotropic_energy.h"

namespace lastflat {

/// Sum over the triangles of surface area times energy density, mm^2.
class Distortion final : public EnergyTerm {
public:
    /// `weights`: per region and triangle; none: all one. `energy` must outlive the distortion.
    Distortion(const Domain& domain, const IsotropicEnergy& energy,
               const std::vector<std::vector<double>>& weights = {});

    /// Weights counted: an isometry has this value.
    [[nodiscard]] double total_area() const { return total_area_; }
    [[nodiscard]] bool scale_free() const { return energy_.scale_free(); }

    /// Infinite if a triangle is flipped or collapsed.
    [[nodiscard]] double value(const Eigen::VectorXd& x) const override;
    void add_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& gradient) const override;
    [[nodiscard]] std::vector<Triangle> elements() const override;
    /// Every triangle must be counter-clockwise at x.
    void for_hessian(const Eigen::VectorXd& x, HessianKind kind,
                     const TakeHessian& take) const override;

    /// Ends before the first triangle collapses.
    ///
    /// Paper: [smith-2015], section 4.2: the smallest positive root of each triangle's area.
    [[nodiscard]] double largest_step(const Eigen::VectorXd& x,
                                      const Eigen::VectorXd& d) const override;

private:
    struct Element {
        Triangle vertices;
        Eigen::Matrix2d rest_inverse;  ///< of [p1 - p0, p2 - p0] in the triangle's plane
        double area;                   ///< times the weight
    };
    [[nodiscard]] static Eigen::Matrix2d gradient_of(const Element& element,
                                                     const Eigen::VectorXd& x);

    const IsotropicEnergy& energy_;
    std::vector<Element> elements_;
    double total_area_ = 0.0;
};

}  // namespace lastflat
