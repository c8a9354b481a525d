// The dense inner loops of the sparse factorization.
#pragma once

#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

/// The pivot block of a front and the rows below it, column-major: `rows` x `columns`,
/// rows >= columns.
struct Panel {
    double* values;
    std::size_t rows, columns;
    [[nodiscard]] double* column(std::size_t j) const { return values + j * rows; }
};

/// Reused between calls, so that nothing is allocated in the loops.
struct PackBuffers {
    std::vector<double> left, right;
};

/// P = L D L11^T for the panel: L, whose diagonal of ones is not stored, takes the panel's place,
/// the pivots its diagonal. Without pivoting: the matrix is positive definite or quasi-definite.
/// False if a pivot vanishes or is not finite.
[[nodiscard]] bool factor_panel(const Panel& panel, PackBuffers& buffers);

/// Lower triangle of S minus that of L2 D L2^T, L2 the panel's rows below its pivots. S is
/// column-major of order rows - columns.
///
/// Every entry is a sum in one fixed order, whatever vectors the machine has.
void subtract_outer_product(const Panel& panel, double* schur, PackBuffers& buffers);

}  // namespace lastflat
