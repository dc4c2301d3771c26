// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace meltray {

using Vec3 = Eigen::Vector3d;
using Index = std::int32_t;

/// Up to three components stored as separate arrays. In 3-D: 0 = x (feed), 1 = y, 2 = z (up).
/// In 2-D: 0 = x, 1 = z (up); the third array stays empty.
using Components = std::array<std::vector<double>, 3>;

/// Upper triangle of a symmetric tensor, row by row: xx, xy, xz, yy, yz, zz; in 2-D xx, xz, zz.
using SymmetricComponents = std::array<std::vector<double>, 6>;
/// How many of them a scene of dimension `dim` has.
constexpr int symmetric_count(int dim) {
  return dim * (dim + 1) / 2;
}

/// Read-only and writable views of Components; unused components are null.
using ConstField = std::array<const double*, 3>;
using MutField = std::array<double*, 3>;

inline ConstField view(const Components& c) {
  return {c[0].data(), c[1].data(), c[2].data()};
}
inline MutField view(Components& c) {
  return {c[0].data(), c[1].data(), c[2].data()};
}

}  // namespace meltray
