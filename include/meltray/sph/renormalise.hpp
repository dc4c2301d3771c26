// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>

namespace meltray::sph {

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
