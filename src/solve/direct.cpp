// SPDX-License-Identifier: MIT
#include "meltray/solve/direct.hpp"

#include <cholmod.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "meltray/core/errors.hpp"

namespace meltray {

/// CHOLMOD's workspace and factor. The matrix is scaled symmetrically to a diagonal of order one, by powers
/// of two so that no digit changes: the pivots then tell how singular it is, whatever its units.
struct CholeskySolver::Impl {
  cholmod_common common;
  cholmod_factor* factor = nullptr;
  cholmod_dense *solution = nullptr, *work_y = nullptr, *work_e = nullptr;
  std::vector<SuiteSparse_long> start, row;  ///< pattern of the last matrix, in CHOLMOD's integers
  std::vector<double> value, scale, right;

  Impl() {
    cholmod_l_start(&common);
    common.print = 0;     // failures are reported by exceptions
    common.final_ll = 1;  // L L^T: unlike L D L^T it does not accept indefinite matrices
    common.quick_return_if_not_posdef = 1;
  }
  ~Impl() {
    free_factor();
    cholmod_l_free_dense(&solution, &common);
    cholmod_l_free_dense(&work_y, &common);
    cholmod_l_free_dense(&work_e, &common);
    cholmod_l_finish(&common);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void free_factor() { cholmod_l_free_factor(&factor, &common); }

  [[noreturn]] void fail(const std::string& message) {
    free_factor();
    throw NumericalFailure(message);
  }

  void scale_values(const CsrView& a) {
    const std::size_t n = a.size();
    scale.assign(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      double diagonal = 0;
      for (auto k = a.row_start[i]; k < a.row_start[i + 1]; ++k)
        if (static_cast<std::size_t>(a.column[k]) == i) diagonal += a.value[k];
      if (!(diagonal > 0) || !std::isfinite(diagonal))
        fail(fmt::format("Cholesky factorisation: diagonal entry {} of {} unknowns is {}, not positive", i, n,
                         diagonal));
      scale[i] = std::ldexp(1.0, -(std::ilogb(diagonal) / 2));
    }
    value.resize(a.value.size());
    for (std::size_t i = 0; i < n; ++i)
      for (auto k = a.row_start[i]; k < a.row_start[i + 1]; ++k)
        value[k] = a.value[k] * scale[i] * scale[a.column[k]];
  }

  bool same_pattern(const CsrView& a) const {
    return factor && std::equal(a.row_start.begin(), a.row_start.end(), start.begin(), start.end()) &&
           std::equal(a.column.begin(), a.column.end(), row.begin(), row.end());
  }

  /// The rows of a symmetric matrix are its columns, so CSR serves as CHOLMOD's compressed columns; it reads
  /// the upper triangle and skips the other.
  cholmod_sparse as_columns() {
    cholmod_sparse a{};
    a.nrow = a.ncol = scale.size();
    a.nzmax = value.size();
    a.p = start.data();
    a.i = row.data();
    a.x = value.data();
    a.stype = 1;
    a.itype = CHOLMOD_LONG;
    a.xtype = CHOLMOD_REAL;
    a.dtype = CHOLMOD_DOUBLE;
    a.sorted = 0;
    a.packed = 1;
    return a;
  }
};

CholeskySolver::CholeskySolver() : impl_(std::make_unique<Impl>()) {}
CholeskySolver::~CholeskySolver() = default;
CholeskySolver::CholeskySolver(CholeskySolver&&) noexcept = default;
CholeskySolver& CholeskySolver::operator=(CholeskySolver&&) noexcept = default;

void CholeskySolver::factor(const CsrView& a) {
  Impl& s = *impl_;
  const std::size_t n = a.size();
  if (n == 0 || a.column.size() != a.value.size() ||
      static_cast<std::size_t>(a.row_start.back()) != a.value.size())
    throw std::invalid_argument("CholeskySolver::factor: the arrays of the matrix do not belong together");
  s.scale_values(a);
  const bool analysed = s.same_pattern(a);
  if (!analysed) {
    s.free_factor();
    s.start.assign(a.row_start.begin(), a.row_start.end());
    s.row.assign(a.column.begin(), a.column.end());
  }
  cholmod_sparse columns = s.as_columns();
  if (!analysed) s.factor = cholmod_l_analyze(&columns, &s.common);
  if (s.factor) cholmod_l_factorize(&columns, s.factor, &s.common);
  if (s.common.status < CHOLMOD_OK)
    s.fail(fmt::format("Cholesky factorisation of {} unknowns: CHOLMOD error {}{}", n, s.common.status,
                       s.common.status == CHOLMOD_OUT_OF_MEMORY ? " (out of memory)" : ""));
  if (s.factor->minor < n) {
    const auto unknown = static_cast<const SuiteSparse_long*>(s.factor->Perm)[s.factor->minor];
    s.fail(
        fmt::format("Cholesky factorisation: the matrix of {} unknowns is not positive definite (unknown {})",
                    n, unknown));
  }
  // Round-off alone leaves a singular matrix with pivots of order n eps instead of 0.
  const double ratio = cholmod_l_rcond(s.factor, &s.common);
  if (!(ratio > static_cast<double>(n) * std::numeric_limits<double>::epsilon()))
    s.fail(
        fmt::format("Cholesky factorisation: the matrix of {} unknowns is singular to working precision "
                    "(ratio of pivots {:.1e})",
                    n, ratio));
}

void CholeskySolver::solve(std::span<const double> b, std::span<double> x) {
  Impl& s = *impl_;
  const std::size_t n = s.scale.size();
  if (!s.factor || b.size() != n || x.size() != n)
    throw std::invalid_argument("CholeskySolver::solve: no factor, or vectors of another size");
  s.right.resize(n);
  for (std::size_t i = 0; i < n; ++i) s.right[i] = s.scale[i] * b[i];
  cholmod_dense right{};
  right.nrow = right.d = right.nzmax = n;
  right.ncol = 1;
  right.x = s.right.data();
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  if (!cholmod_l_solve2(CHOLMOD_A, s.factor, &right, nullptr, &s.solution, nullptr, &s.work_y, &s.work_e,
                        &s.common))
    throw NumericalFailure(
        fmt::format("Cholesky solve of {} unknowns: CHOLMOD error {}", n, s.common.status));
  const auto* y = static_cast<const double*>(s.solution->x);
  for (std::size_t i = 0; i < n; ++i) x[i] = s.scale[i] * y[i];
}

std::int64_t CholeskySolver::factor_entries() const {
  return impl_->factor ? static_cast<std::int64_t>(impl_->common.lnz) : 0;
}

namespace solve {

SolveReport DirectSolver::solve(const SymmetricMatrix& a, const std::vector<double>& b,
                                const std::vector<Index>& held, std::vector<double>& x) {
  const Index n = a.rows();
  start_.assign(1, 0);
  column_.clear();
  value_.clear();
  right_ = b;
  std::vector<bool> is_held(n, false);
  for (Index i : held) is_held[i] = true;
  for (Index i = 0; i < n; ++i) {
    const bool alone = !(a.diagonal[i] > 0);
    column_.push_back(i);
    // Adding to the diagonal of a singular component holds that row at 0, since the others sum to nothing.
    value_.push_back(alone ? 1.0 : (is_held[i] ? 2 : 1) * a.diagonal[i]);
    if (alone) right_[i] = 0;
    for (Index k = a.start[i]; k < a.start[i + 1]; ++k) {
      column_.push_back(a.column[k]);
      value_.push_back(-static_cast<double>(a.off[k]));
    }
    start_.push_back(static_cast<std::int64_t>(column_.size()));
  }
  cholesky_.factor({start_, column_, value_});
  x.resize(n);
  cholesky_.solve(right_, x);
  product_.resize(n);
  multiply(a, x, product_);
  double gap = 0, size = 0;
  for (Index i = 0; i < n; ++i) {
    if (!(a.diagonal[i] > 0)) continue;
    gap += (b[i] - product_[i]) * (b[i] - product_[i]) / a.diagonal[i];
    size += b[i] * b[i] / a.diagonal[i];
  }
  return {0, size > 0 ? std::sqrt(gap / size) : 0.0, true};
}

}  // namespace solve

}  // namespace meltray
