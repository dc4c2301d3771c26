// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <experimental/simd>

#include "meltray/core/vec.hpp"

/// Tensors of elastic solid in columns padded to what a register holds, so that a pair reads its neighbour's
/// side by side.
namespace meltray::terms {

template <int D>
inline constexpr int kWidth = D == 3 ? 4 : 2;
template <int D>
using Lane = std::experimental::simd<double, std::experimental::simd_abi::deduce_t<double, kWidth<D>>>;
/// Doubles of a matrix of D padded columns in memory.
template <int D>
inline constexpr std::size_t kColumnsSize = static_cast<std::size_t>(kWidth<D>) * D;
/// Where the two tensors of particle i begin in an array of them.
template <int D>
std::size_t tensors_begin(Index i) {
  return static_cast<std::size_t>(i) * 2 * kColumnsSize<D>;
}

template <int D>
Lane<D> load_lane(const double* from) {
  return Lane<D>(from, std::experimental::element_aligned);
}

/// A matrix of D padded columns in memory.
template <int D>
Eigen::Matrix<double, D, D> load_matrix(const double* from) {
  return Eigen::Map<const Eigen::Matrix<double, kWidth<D>, D>>(from).template topRows<D>();
}

template <int D>
void store_matrix(const Eigen::Matrix<double, D, D>& matrix, double* to) {
  Eigen::Map<Eigen::Matrix<double, kWidth<D>, D>> padded(to);
  padded.setZero();
  padded.template topRows<D>() = matrix;
}

}  // namespace meltray::terms
