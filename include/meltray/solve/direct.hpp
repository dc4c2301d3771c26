// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "meltray/core/vec.hpp"
#include "meltray/solve/conjugate_gradient.hpp"

namespace meltray {

/// A square sparse matrix by rows that belongs to someone else: row i has the entries row_start[i] to
/// row_start[i + 1] of `column` and `value`. Symmetric matrices carry both triangles.
struct CsrView {
  std::span<const std::int64_t> row_start;  ///< size + 1 entries
  std::span<const Index> column;
  std::span<const double> value;
  std::size_t size() const { return row_start.empty() ? 0 : row_start.size() - 1; }
};

/// Sparse Cholesky factorisation (CHOLMOD) of a symmetric positive definite matrix: the exact answer that
/// iterative solvers are judged by.
class CholeskySolver {
 public:
  CholeskySolver();
  ~CholeskySolver();
  CholeskySolver(CholeskySolver&&) noexcept;
  CholeskySolver& operator=(CholeskySolver&&) noexcept;

  /// Factorises the matrix. The fill-reducing order is kept when the pattern is that of the last call.
  /// Throws NumericalFailure if the matrix is not positive definite to working precision, or too large.
  void factor(const CsrView& matrix);
  /// Solves A x = b with the last factor. `b` and `x` may be the same memory.
  void solve(std::span<const double> b, std::span<double> x);
  /// Entries of the factor L; 0 before the first call of factor().
  std::int64_t factor_entries() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

namespace solve {

/// Exact solution of A x = b in place of ConjugateGradient.
class DirectSolver {
 public:
  /// `x` of rows in `held`, and of rows without entries, is 0: one row of each component that is singular has
  /// to be held, and b has no sum there. Returns a report with no iterations. Throws NumericalFailure if A is
  /// not positive definite otherwise.
  SolveReport solve(const SymmetricMatrix& a, const std::vector<double>& b, const std::vector<Index>& held,
                    std::vector<double>& x);

 private:
  CholeskySolver cholesky_;
  std::vector<std::int64_t> start_;
  std::vector<Index> column_;
  std::vector<double> value_, product_, right_;
};

}  // namespace solve
}  // namespace meltray
