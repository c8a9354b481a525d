// The distortion of a whole chart, as a function of its points: value, gradient, Hessian.
#pragma once

#include "core/parameterize/domain.h"
#include "core/parameterize/isotropic_energy.h"

namespace lastflat {

/// How Hessians of single triangles enter the sum.
enum class HessianKind {
    projected,  ///< clamped to be positive semi-definite: always a direction of descent
    exact,      ///< as they are: quadratic convergence near a minimum
};

/// Sum over the triangles of surface area times energy density, mm^2.
class Distortion {
public:
    /// `weights`: per region and triangle; none: all one. `energy` must outlive the distortion.
    Distortion(const Domain& domain, const IsotropicEnergy& energy,
               const std::vector<std::vector<double>>& weights = {});

    /// Weights counted: an isometry has this value.
    [[nodiscard]] double total_area() const { return total_area_; }
    [[nodiscard]] bool scale_free() const { return energy_.scale_free(); }

    /// Infinite if a triangle is flipped or collapsed.
    [[nodiscard]] double value(const Eigen::VectorXd& x) const;

    /// Largest step t for which x + t d has no collapsed triangle; infinite if there is none.
    ///
    /// Paper: [smith-2015], section 4.2: the smallest positive root of each triangle's area.
    [[nodiscard]] double collapse_step(const Eigen::VectorXd& x, const Eigen::VectorXd& d) const;

    /// Finds where the lower triangles of the element Hessians stand in `matrix`, whose pattern
    /// must hold a 2x2 block for every pair of vertices that share a triangle.
    void bind(const SparseMatrix& matrix);

    /// Adds the Hessian to the values of the bound matrix.
    /// Every triangle must be counter-clockwise at x.
    void add_hessian(const Eigen::VectorXd& x, HessianKind kind, SparseMatrix& matrix) const;

    [[nodiscard]] Eigen::VectorXd gradient(const Eigen::VectorXd& x) const;

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
    std::vector<std::array<Index, 21>> slots_;
    double total_area_ = 0.0;
};

}  // namespace lastflat
