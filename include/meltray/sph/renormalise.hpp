// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>

#include "meltray/sph/pairs.hpp"

namespace meltray::sph {

/// Adds one pair, V_j F_ij = `vf`, to the kernel moment matrix M = -sum V F x x^T.
template <int D>
void add_moment(Eigen::Matrix<double, D, D>& moment, double vf, const Pair<D>& p) {
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) moment(a, b) -= vf * p.x[a] * p.x[b];
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
