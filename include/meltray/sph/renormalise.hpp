// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>

#include "meltray/sph/pairs.hpp"

namespace meltray::sph {

/// What neighbours with V_j F_ij = `vf` add to the kernel moment matrix M = -sum V F x x^T; written to the
/// symmetric_count(D) places at `out`.
template <int D>
void moments(const Lanes& vf, const PairLanes<D>& p, Lanes* out) {
  for (int a = 0; a < D; ++a)
    for (int b = a; b < D; ++b) *out++ = -vf * p.x[a] * p.x[b];
}

/// The matrix of symmetric_count(D) numbers, its rows from the diagonal on.
template <int D>
Eigen::Matrix<double, D, D> symmetric(const double* numbers) {
  Eigen::Matrix<double, D, D> matrix;
  for (int a = 0; a < D; ++a)
    for (int b = a; b < D; ++b) matrix(a, b) = matrix(b, a) = *numbers++;
  return matrix;
}

/// Inverse of a kernel moment matrix M = -sum V F x x^T (identity deep inside): gradients multiplied by it
/// are exact for linear fields. A thin sheet has no extent across it and M is singular: a small ridge keeps
/// the inverse finite there, and only there.
template <int D>
Eigen::Matrix<double, D, D> renormalisation(Eigen::Matrix<double, D, D> moment) {
  constexpr double kWellPosed = 0.005, kRidge = 1e-3;
  if (!(moment.determinant() > kWellPosed)) moment.diagonal().array() += kRidge;
  return moment.inverse();
}

}  // namespace meltray::sph
