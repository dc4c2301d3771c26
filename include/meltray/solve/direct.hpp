// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "meltray/core/vec.hpp"

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
/// iterative solvers are judged by in tests.
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

}  // namespace meltray
