// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "meltray/core/parallel.hpp"
#include "meltray/core/vec.hpp"

namespace meltray::solve {

/// Symmetric matrix A = diag - off with off-diagonals stored by rows (both triangles), off >= 0 for the
/// Laplacians of this program, in single precision: the product is bound by memory.
struct SymmetricMatrix {
  std::vector<Index> start{0}, column;
  std::vector<float> off;        ///< -A_ij
  std::vector<double> diagonal;  ///< A_ii
  Index rows() const { return static_cast<Index>(diagonal.size()); }
};

/// y = A x.
void multiply(const SymmetricMatrix& a, const std::vector<double>& x, std::vector<double>& y);

struct SolveReport {
  int iterations = 0;
  double residual = 0;  ///< |b - A x| / |b|, both in the norm of the inverse diagonal
  bool converged = false;
};

/// Vectors of a conjugate-gradient solve with D components a row; entries that are not rows stay 0.
template <int D>
struct CgVectors {
  std::array<std::vector<double>, D> r, p, ap;  ///< r: the right-hand side on entry
  std::vector<double> inverse_diagonal;
  void resize(std::size_t n) {
    inverse_diagonal.resize(n);
    for (int c = 0; c < D; ++c) {
      r[c].resize(n);
      ap[c].resize(n);
      p[c].assign(n, 0.0);
    }
  }
};

/// What the residual is measured against.
enum class Relative { to_right_hand_side, to_start };

/// Conjugate gradients for a symmetric positive definite A that exists as `apply(i, in)`, row i of A times
/// `in` (D arrays), with a diagonal preconditioner; row_of(k) for k in [0, rows) names the rows. Solves A x =
/// v.r from the start vector in x until |b - A x| <= tolerance |b| (or tolerance times its value at the
/// start) in the norm of the inverse diagonal; v.r then holds b - A x. Bitwise independent of the number of
/// threads. A singular consistent system is solved in the range of A.
template <int D, class RowOf, class Apply>
SolveReport conjugate_gradient(std::ptrdiff_t rows, RowOf&& row_of, Apply&& apply, CgVectors<D>& v,
                               const std::array<double*, D>& x, double tolerance, int max_iterations,
                               Relative relative = Relative::to_right_hand_side) {
  using Row = std::array<double, D>;
  const double* const inverse = v.inverse_diagonal.data();
  std::array<double*, D> r, p, ap;
  std::array<const double*, D> p_in, x_in;
  for (int c = 0; c < D; ++c) {
    r[c] = v.r[c].data();
    p_in[c] = p[c] = v.p[c].data();
    ap[c] = v.ap[c].data();
    x_in[c] = x[c];
  }
  const auto preconditioned = [&](Index i) {
    double sum = 0;
    for (int c = 0; c < D; ++c) sum += r[c][i] * r[c][i];
    return sum * inverse[i];
  };
  SolveReport report;
  double scale = 0;
  if (relative == Relative::to_right_hand_side)
    scale = parallel_sum_rows(rows, [&](std::ptrdiff_t k) { return preconditioned(row_of(k)); });
  if (relative == Relative::to_right_hand_side && scale == 0) {
    parallel_for(rows, [&](std::ptrdiff_t k) {
      for (int c = 0; c < D; ++c) x[c][row_of(k)] = 0;
    });
    report.converged = true;
    return report;
  }
  double rz = parallel_sum_rows(rows, [&](std::ptrdiff_t k) {
    const Index i = row_of(k);
    const Row ax = apply(i, x_in);
    for (int c = 0; c < D; ++c) {
      r[c][i] -= ax[c];
      p[c][i] = inverse[i] * r[c][i];
    }
    return preconditioned(i);
  });
  if (relative == Relative::to_start) scale = rz;
  const double target = tolerance * tolerance * scale;
  while (rz > target && report.iterations < max_iterations) {
    const double curvature = parallel_sum_rows(rows, [&](std::ptrdiff_t k) {
      const Index i = row_of(k);
      const Row a = apply(i, p_in);
      double sum = 0;
      for (int c = 0; c < D; ++c) {
        ap[c][i] = a[c];
        sum += p[c][i] * a[c];
      }
      return sum;
    });
    if (!(curvature > 0)) break;
    const double alpha = rz / curvature;
    const double next = parallel_sum_rows(rows, [&](std::ptrdiff_t k) {
      const Index i = row_of(k);
      for (int c = 0; c < D; ++c) {
        x[c][i] += alpha * p[c][i];
        r[c][i] -= alpha * ap[c][i];
      }
      return preconditioned(i);
    });
    const double beta = next / rz;
    rz = next;
    parallel_for(rows, [&](std::ptrdiff_t k) {
      const Index i = row_of(k);
      for (int c = 0; c < D; ++c) p[c][i] = inverse[i] * r[c][i] + beta * p[c][i];
    });
    ++report.iterations;
  }
  report.residual = scale > 0 ? std::sqrt(rz / scale) : 0.0;
  report.converged = rz <= target;
  return report;
}

/// The same for a stored matrix; keeps its vectors between solves.
class ConjugateGradient {
 public:
  /// Solves A x = b from the start vector in x.
  SolveReport solve(const SymmetricMatrix& a, const std::vector<double>& b, std::vector<double>& x,
                    double tolerance, int max_iterations);

 private:
  CgVectors<1> vectors_;
};

/// Finds the connected groups of rows without any row of `anchored` > 0 and numbers them from 1 (0 = anchored
/// group). Returns how many there are. `scratch` is overwritten: kept by the caller, it spares allocations.
int floating_components(const SymmetricMatrix& a, const std::vector<double>& anchored,
                        std::vector<Index>& group, std::vector<Index>& scratch);

}  // namespace meltray::solve
