// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <array>
#include <experimental/simd>

#include "meltray/core/vec.hpp"

/// Vectors of the loops over pairs of elastic solid, padded to what a register holds: a pair adds to nine and
/// more sums at once, and each neighbour's tensors lie side by side.
namespace meltray::terms {

template <int D>
inline constexpr int kWidth = D == 3 ? 4 : 2;
template <int D>
using Lane = std::experimental::simd<double, std::experimental::simd_abi::deduce_t<double, kWidth<D>>>;
/// Matrix of D padded columns.
template <int D>
using Columns = std::array<Lane<D>, D>;
/// Doubles of a matrix of D padded columns in memory.
template <int D>
inline constexpr std::size_t kColumnsSize = static_cast<std::size_t>(kWidth<D>) * D;
/// Where the two tensors of particle i begin in an array of them.
template <int D>
std::size_t tensors_begin(Index i) {
  return static_cast<std::size_t>(i) * 2 * kColumnsSize<D>;
}

/// In a register from the start: written to memory component by component and read back as a whole, a vector
/// waits for its stores.
template <int D>
Lane<D> padded(const std::array<double, D>& x) {
  return Lane<D>([&](auto c) {
    if constexpr (c < D)
      return x[c];
    else
      return 0.0;
  });
}

template <int D>
Lane<D> load_lane(const double* from) {
  return Lane<D>(from, std::experimental::element_aligned);
}

template <int D>
Columns<D> no_columns() {
  Columns<D> out;
  out.fill(0);
  return out;
}

template <int D>
Columns<D> load_columns(const double* from) {
  Columns<D> out;
  for (int b = 0; b < D; ++b) out[b] = load_lane<D>(from + b * kWidth<D>);
  return out;
}

template <int D>
Eigen::Matrix<double, D, 1> vector_of(const Lane<D>& lane) {
  Eigen::Matrix<double, D, 1> out;
  for (int c = 0; c < D; ++c) out[c] = lane[c];
  return out;
}

template <int D>
Eigen::Matrix<double, D, D> matrix_of(const Columns<D>& columns) {
  Eigen::Matrix<double, D, D> out;
  for (int b = 0; b < D; ++b) out.col(b) = vector_of<D>(columns[b]);
  return out;
}

template <int D>
void store_columns(const Eigen::Matrix<double, D, D>& matrix, double* to) {
  for (int b = 0; b < D; ++b)
    for (int c = 0; c < kWidth<D>; ++c) to[b * kWidth<D> + c] = c < D ? matrix(c, b) : 0.0;
}

}  // namespace meltray::terms
