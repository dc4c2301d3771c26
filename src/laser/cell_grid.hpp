// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "meltray/core/vec.hpp"

namespace meltray::laser {

/// Points sorted into cubic cells, for searches within a radius.
class CellGrid {
 public:
  /// Cells of about `size`, larger where the points are so scattered that most cells would be empty.
  CellGrid(std::span<const Vec3> points, double size);

  /// Calls f(index of point, point) for the points of all cells within `radius` of x: those within the radius
  /// and some more, always in the same order.
  template <class F>
  void near(const Vec3& x, double radius, F&& f) const {
    if (start_.empty()) return;
    std::array<std::ptrdiff_t, 3> low, high;
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = cell(a, x[static_cast<int>(a)] - radius);
      high[a] = cell(a, x[static_cast<int>(a)] + radius);
    }
    for (std::ptrdiff_t k = low[2]; k <= high[2]; ++k)
      for (std::ptrdiff_t j = low[1]; j <= high[1]; ++j) {
        const std::size_t row = static_cast<std::size_t>((k * n_[1] + j) * n_[0]);
        const std::size_t first = start_[row + static_cast<std::size_t>(low[0])];
        const std::size_t last = start_[row + static_cast<std::size_t>(high[0]) + 1];
        for (std::size_t q = first; q < last; ++q) f(order_[q], sorted_[q]);
      }
  }
  /// Diagonal of the box around the points [m].
  double diagonal() const { return (high_ - low_).norm(); }
  const Vec3& centre() const { return centre_; }

 private:
  /// Cell along an axis, of the nearest end for coordinates outside.
  std::ptrdiff_t cell(std::size_t axis, double coordinate) const;

  Vec3 low_, high_, centre_;
  double size_;
  std::array<std::ptrdiff_t, 3> n_{};
  std::vector<std::size_t> start_, order_;
  std::vector<Vec3> sorted_;
};

}  // namespace meltray::laser
