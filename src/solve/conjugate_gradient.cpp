// SPDX-License-Identifier: MIT
#include "meltray/solve/conjugate_gradient.hpp"

#include <cmath>

#include "meltray/core/parallel.hpp"

namespace meltray::solve {

void multiply(const SymmetricMatrix& a, const std::vector<double>& x, std::vector<double>& y) {
  const double* const in = x.data();
  const double* const off = a.off.data();
  const Index* const column = a.column.data();
  parallel_for(a.rows(), [&](Index i) {
    double sum = 0;
    const Index last = a.start[i + 1];
#pragma omp simd reduction(+ : sum)
    for (Index k = a.start[i]; k < last; ++k) sum += off[k] * in[column[k]];
    y[i] = a.diagonal[i] * in[i] - sum;
  });
}

SolveReport ConjugateGradient::solve(const SymmetricMatrix& a, const std::vector<double>& b,
                                     std::vector<double>& x, double tolerance, int max_iterations) {
  const Index n = a.rows();
  for (auto* v : {&r_, &p_, &ap_, &inverse_}) v->resize(n);
  parallel_for(n, [&](Index i) { inverse_[i] = a.diagonal[i] > 0 ? 1 / a.diagonal[i] : 0.0; });
  const double* const inverse = inverse_.data();
  const double scale = parallel_sum(n, [&](std::ptrdiff_t i) { return b[i] * b[i] * inverse[i]; });
  SolveReport report;
  if (scale == 0) {
    parallel_for(n, [&](Index i) { x[i] = 0; });
    report.converged = true;
    return report;
  }
  multiply(a, x, ap_);
  parallel_for(n, [&](Index i) {
    r_[i] = b[i] - ap_[i];
    p_[i] = inverse[i] * r_[i];
  });
  double rz = parallel_sum(n, [&](std::ptrdiff_t i) { return r_[i] * r_[i] * inverse[i]; });
  const double target = tolerance * tolerance * scale;
  while (rz > target && report.iterations < max_iterations) {
    multiply(a, p_, ap_);
    const double curvature = parallel_sum(n, [&](std::ptrdiff_t i) { return p_[i] * ap_[i]; });
    if (!(curvature > 0)) break;
    const double alpha = rz / curvature;
    parallel_for(n, [&](Index i) {
      x[i] += alpha * p_[i];
      r_[i] -= alpha * ap_[i];
    });
    const double next = parallel_sum(n, [&](std::ptrdiff_t i) { return r_[i] * r_[i] * inverse[i]; });
    const double beta = next / rz;
    rz = next;
    parallel_for(n, [&](Index i) { p_[i] = inverse[i] * r_[i] + beta * p_[i]; });
    ++report.iterations;
  }
  report.residual = std::sqrt(rz / scale);
  report.converged = rz <= target;
  return report;
}

int floating_components(const SymmetricMatrix& a, const std::vector<double>& anchored,
                        std::vector<Index>& group) {
  const Index n = a.rows();
  group.assign(n, -1);
  std::vector<Index> stack;
  const auto flood = [&](Index number) {
    while (!stack.empty()) {
      const Index i = stack.back();
      stack.pop_back();
      for (Index k = a.start[i]; k < a.start[i + 1]; ++k) {
        const Index j = a.column[k];
        if (group[j] >= 0 || a.off[k] == 0) continue;
        group[j] = number;
        stack.push_back(j);
      }
    }
  };
  for (Index i = 0; i < n; ++i)
    if (anchored[i] > 0) {
      group[i] = 0;
      stack.push_back(i);
    }
  flood(0);
  int count = 0;
  for (Index i = 0; i < n; ++i) {
    if (group[i] >= 0) continue;
    group[i] = ++count;
    stack.push_back(i);
    flood(count);
  }
  return count;
}

}  // namespace meltray::solve
