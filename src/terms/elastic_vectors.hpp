// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <array>

/// Vectors of the loops over pairs of elastic solid, padded to what a register holds: a pair adds to nine and
/// more sums at once, and each neighbour's tensors lie side by side.
namespace meltray::terms {

template <int D>
inline constexpr int kWidth = D == 3 ? 4 : 2;
template <int D>
using Lane = Eigen::Matrix<double, kWidth<D>, 1>;
/// Matrix of D padded columns.
template <int D>
using Columns = Eigen::Matrix<double, kWidth<D>, D>;

template <int D>
Lane<D> padded(const std::array<double, D>& x) {
  Lane<D> out = Lane<D>::Zero();
  for (int c = 0; c < D; ++c) out[c] = x[c];
  return out;
}

/// Entry i of an array of lanes, or of matrices of `Wide`.
template <class Wide>
Eigen::Map<const Wide> entry(const double* of, std::size_t i) {
  return Eigen::Map<const Wide>(of + i * Wide::SizeAtCompileTime);
}
template <class Wide>
Eigen::Map<Wide> entry(double* of, std::size_t i) {
  return Eigen::Map<Wide>(of + i * Wide::SizeAtCompileTime);
}

}  // namespace meltray::terms
