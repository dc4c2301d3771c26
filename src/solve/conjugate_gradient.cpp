// SPDX-License-Identifier: MIT
#include "meltray/solve/conjugate_gradient.hpp"

#include <algorithm>

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
                        std::vector<Index>& group, std::vector<Index>& scratch) {
  const Index n = a.rows();
  group.assign(n, -1);
  std::vector<Index>& open = scratch;
  open.clear();
  for (Index i = 0; i < n; ++i)
    if (anchored[i] > 0)
      group[i] = 0;
    else
      open.push_back(i);
  // Each open row looks for a neighbour in the anchored group: nearly all find one among their first, in a
  // few sweeps up and down.
  const auto joins = [&](Index i) {
    for (Index k = a.start[i]; k < a.start[i + 1]; ++k)
      if (group[a.column[k]] == 0 && a.off[k] != 0) return true;
    return false;
  };
  for (std::size_t before = 0; before != open.size();) {
    before = open.size();
    std::erase_if(open, [&](Index i) {
      if (!joins(i)) return false;
      group[i] = 0;
      return true;
    });
    std::reverse(open.begin(), open.end());
  }
  // What is left hangs on nothing.
  std::sort(open.begin(), open.end());
  const std::size_t floating = open.size();
  int count = 0;
  for (std::size_t f = 0; f < floating; ++f) {
    if (group[open[f]] >= 0) continue;
    group[open[f]] = ++count;
    open.push_back(open[f]);
    while (open.size() > floating) {
      const Index i = open.back();
      open.pop_back();
      for (Index k = a.start[i]; k < a.start[i + 1]; ++k) {
        const Index j = a.column[k];
        if (group[j] >= 0 || a.off[k] == 0) continue;
        group[j] = count;
        open.push_back(j);
      }
    }
  }
  return count;
}

}  // namespace meltray::solve
