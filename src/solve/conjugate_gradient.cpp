// SPDX-License-Identifier: MIT
#include "meltray/solve/conjugate_gradient.hpp"

namespace meltray::solve {

namespace {

double row_times(const SymmetricMatrix& a, Index i, const double* x) {
  double sum = 0;
  const float* const off = a.off.data();
  const Index* const column = a.column.data();
  const Index last = a.start[i + 1];
#pragma omp simd reduction(+ : sum)
  for (Index k = a.start[i]; k < last; ++k) sum += static_cast<double>(off[k]) * x[column[k]];
  return a.diagonal[i] * x[i] - sum;
}

}  // namespace

void multiply(const SymmetricMatrix& a, const std::vector<double>& x, std::vector<double>& y) {
  parallel_for(a.rows(), [&](Index i) { y[i] = row_times(a, i, x.data()); });
}

SolveReport ConjugateGradient::solve(const SymmetricMatrix& a, const std::vector<double>& b,
                                     std::vector<double>& x, double tolerance, int max_iterations) {
  const Index n = a.rows();
  vectors_.resize(n);
  parallel_for(n, [&](Index i) {
    vectors_.inverse_diagonal[i] = a.diagonal[i] > 0 ? 1 / a.diagonal[i] : 0.0;
    vectors_.r[0][i] = b[i];
  });
  return conjugate_gradient<1>(
      n, [](std::ptrdiff_t k) { return static_cast<Index>(k); },
      [&](Index i, const std::array<const double*, 1>& in) {
        return std::array<double, 1>{row_times(a, i, in[0])};
      },
      vectors_, {x.data()}, tolerance, max_iterations);
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
