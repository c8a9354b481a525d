// Based on: Goto, van de Geijn, "Anatomy of High-Performance Matrix Multiplication", ACM TOMS 2008.
#include "core/numerics/dense_ldlt.h"

#include <algorithm>
#include <cmath>

namespace lastflat {
namespace {

/// A tile of the target: this many rows and columns stay in registers.
constexpr std::size_t tile_rows = 8, tile_columns = 4;
/// How many columns of a panel are factored one by one before the rest sees them.
constexpr std::size_t strip = 24;
/// How many products a tile sums up in one go: two packed slivers stay in the first cache.
constexpr std::size_t most_terms = 192;

using Quad [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;

/// tile = sum over k of left(:, k) right(k, :), slivers packed k by k.
[[gnu::always_inline]] inline void multiply_tile(const double* left, const double* right,
                                                 std::size_t terms, double* tile) {
    Quad low[tile_columns]{}, high[tile_columns]{};
    for (std::size_t k = 0; k < terms; ++k) {
        const Quad a = *reinterpret_cast<const Quad*>(left + k * tile_rows);
        const Quad b = *reinterpret_cast<const Quad*>(left + k * tile_rows + 4);
        for (std::size_t j = 0; j < tile_columns; ++j) {
            const double value = right[k * tile_columns + j];
            const Quad r{value, value, value, value};
            low[j] += a * r;
            high[j] += b * r;
        }
    }
    for (std::size_t j = 0; j < tile_columns; ++j) {
        *reinterpret_cast<Quad*>(tile + j * tile_rows) = low[j];
        *reinterpret_cast<Quad*>(tile + j * tile_rows + 4) = high[j];
    }
}

/// target -= left right^T where row >= column; `left` in slivers of tile_rows rows, `right` of
/// tile_columns. Row i of the target is row i of left, column j row j of right.
[[gnu::always_inline]] inline void subtract_tiles(const double* left, const double* right,
                                                  std::size_t rows, std::size_t columns,
                                                  std::size_t terms, double* target,
                                                  std::size_t stride) {
    alignas(32) double tile[tile_rows * tile_columns];
    for (std::size_t j = 0; j < columns; j += tile_columns) {
        for (std::size_t i = j / tile_rows * tile_rows; i < rows; i += tile_rows) {
            multiply_tile(left + i * terms, right + j * terms, terms, tile);
            const std::size_t height = std::min(tile_rows, rows - i);
            const std::size_t width = std::min(tile_columns, columns - j);
            for (std::size_t c = 0; c < width; ++c) {
                double* to = target + (j + c) * stride + i;
                for (std::size_t r = i < j + c ? j + c - i : 0; r < height; ++r) {
                    to[r] -= tile[c * tile_rows + r];
                }
            }
        }
    }
}

/// Columns begin .. end, which later ones have not seen yet.
[[gnu::always_inline]] inline bool factor_strip(const Panel& panel, std::size_t begin,
                                                std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
        double* column = panel.column(j);
        const double pivot = column[j];
        if (pivot == 0.0 || !std::isfinite(pivot)) return false;
        const double inverse = 1.0 / pivot;
        for (std::size_t c = j + 1; c < end; ++c) {
            double* __restrict target = panel.column(c);
            const double factor = column[c] * inverse;
            for (std::size_t i = c; i < panel.rows; ++i) target[i] -= factor * column[i];
        }
        for (std::size_t i = j + 1; i < panel.rows; ++i) column[i] *= inverse;
    }
    return true;
}

/// The inner loops as one machine runs them best.
struct Kernels {
    void (*subtract_tiles)(const double*, const double*, std::size_t, std::size_t, std::size_t,
                           double*, std::size_t);
    bool (*factor_strip)(const Panel&, std::size_t, std::size_t);
};

void subtract_tiles_plain(const double* left, const double* right, std::size_t rows,
                          std::size_t columns, std::size_t terms, double* target,
                          std::size_t stride) {
    subtract_tiles(left, right, rows, columns, terms, target, stride);
}

bool factor_strip_plain(const Panel& panel, std::size_t begin, std::size_t end) {
    return factor_strip(panel, begin, end);
}

#if defined(__x86_64__)
// The same sums, four at once; no fused multiply-add, which would round differently.

[[gnu::target("avx2")]] void subtract_tiles_avx2(const double* left, const double* right,
                                                 std::size_t rows, std::size_t columns,
                                                 std::size_t terms, double* target,
                                                 std::size_t stride) {
    subtract_tiles(left, right, rows, columns, terms, target, stride);
}

[[gnu::target("avx2")]] bool factor_strip_avx2(const Panel& panel, std::size_t begin,
                                               std::size_t end) {
    return factor_strip(panel, begin, end);
}
#endif

Kernels fastest_kernels() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) return {subtract_tiles_avx2, factor_strip_avx2};
#endif
    return {subtract_tiles_plain, factor_strip_plain};
}

const Kernels& kernels() {
    static const Kernels fastest = fastest_kernels();
    return fastest;
}

/// Rows first .. rows of the panel's columns begin .. end, sliver by sliver, k by k, the missing
/// rows of the last sliver zero; each column times its factor.
template <std::size_t sliver, class Factor>
void pack(const Panel& panel, std::size_t first, std::size_t rows, std::size_t begin,
          std::size_t end, std::vector<double>& packed, const Factor& factor) {
    const std::size_t terms = end - begin;
    const std::size_t size = (rows + sliver - 1) / sliver * sliver * terms;
    if (packed.size() < size) packed.resize(size);
    double* to = packed.data();
    for (std::size_t i = 0; i < rows; i += sliver) {
        const std::size_t height = std::min(sliver, rows - i);
        for (std::size_t k = begin; k < end; ++k) {
            const double* from = panel.column(k) + first + i;
            const double f = factor(k);
            for (std::size_t r = 0; r < height; ++r) *to++ = from[r] * f;
            for (std::size_t r = height; r < sliver; ++r) *to++ = 0.0;
        }
    }
}

/// target -= L D L^T over the panel's columns begin .. end, lower triangle; the target's row 0 is
/// the panel's row `first`.
void subtract_columns(const Panel& panel, std::size_t first, std::size_t columns, std::size_t begin,
                      std::size_t end, double* target, std::size_t stride, PackBuffers& buffers) {
    for (std::size_t k = begin; k < end; k += most_terms) {
        const std::size_t until = std::min(end, k + most_terms);
        pack<tile_rows>(panel, first, panel.rows - first, k, until, buffers.left,
                        [](std::size_t) { return 1.0; });
        pack<tile_columns>(panel, first, columns, k, until, buffers.right,
                           [&](std::size_t c) { return panel.column(c)[c]; });
        kernels().subtract_tiles(buffers.left.data(), buffers.right.data(), panel.rows - first,
                                 columns, until - k, target, stride);
    }
}

}  // namespace

bool factor_panel(const Panel& panel, PackBuffers& buffers) {
    for (std::size_t begin = 0; begin < panel.columns; begin += strip) {
        const std::size_t end = std::min(panel.columns, begin + strip);
        if (!kernels().factor_strip(panel, begin, end)) return false;
        if (end < panel.columns) {
            subtract_columns(panel, end, panel.columns - end, begin, end, panel.column(end) + end,
                             panel.rows, buffers);
        }
    }
    return true;
}

void subtract_outer_product(const Panel& panel, double* schur, PackBuffers& buffers) {
    const std::size_t rest = panel.rows - panel.columns;
    if (rest == 0) return;
    subtract_columns(panel, panel.columns, rest, 0, panel.columns, schur, rest, buffers);
}

}  // namespace lastflat
