// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "meltray/core/vec.hpp"

namespace meltray {

/// A box of equal cells, at least one support radius wide, with optional periodic directions.
/// Positions outside a non-periodic direction fall into the outermost cell.
class CellGrid {
 public:
  CellGrid() = default;
  /// `min`, `max`: box [m]; `width`: least cell width [m]; `periodic` per direction.
  /// Throws UsageError where a periodic direction is shorter than three cells.
  CellGrid(int dim, const Vec3& min, const Vec3& max, double width, std::array<bool, 3> periodic);

  int dim() const { return dim_; }
  Index cells() const { return count_[0] * count_[1] * count_[2]; }
  /// Least width of a cell over the directions [m].
  double width() const {
    double least = 1e300;
    for (int c = 0; c < dim_; ++c) least = std::min(least, 1 / inverse_width_[c]);
    return least;
  }
  /// Period in each direction [m]; 0 where not periodic.
  const std::array<double, 3>& period() const { return period_; }

  std::array<Index, 3> coordinates(const ConstField& x, std::size_t i) const {
    std::array<Index, 3> k{0, 0, 0};
    for (int c = 0; c < dim_; ++c) k[c] = coordinate(c, x[c][i]);
    return k;
  }
  Index cell(const ConstField& x, std::size_t i) const { return flat(coordinates(x, i)); }
  /// Cells above one another follow one another, as particles do in columns of clusters (sph/clusters.hpp).
  Index flat(const std::array<Index, 3>& k) const { return (k[0] * count_[1] + k[1]) * count_[2] + k[2]; }
  std::array<Index, 3> unflatten(Index cell) const {
    return {cell / (count_[1] * count_[2]), (cell / count_[2]) % count_[1], cell % count_[2]};
  }

  /// Calls f(cell) for the cells within `reach` cells of `centre` (itself included), each once.
  template <class F>
  void for_block(Index centre, Index reach, F&& f) const {
    const auto k = unflatten(centre);
    std::array<Index, 3> low{0, 0, 0}, high{0, 0, 0};
    for (int c = 0; c < dim_; ++c) {
      low[c] = k[c] - reach;
      high[c] = k[c] + reach;
      if (period_[c] == 0) {
        low[c] = std::max<Index>(low[c], 0);
        high[c] = std::min<Index>(high[c], count_[c] - 1);
      } else if (2 * reach + 1 > count_[c]) {
        low[c] = 0;
        high[c] = count_[c] - 1;
      }
    }
    for (Index x = low[0]; x <= high[0]; ++x)
      for (Index y = low[1]; y <= high[1]; ++y)
        for (Index z = low[2]; z <= high[2]; ++z) f(flat({wrap(0, x), wrap(1, y), wrap(2, z)}));
  }

  /// Squared distance of a box from a cell [m^2]. The outermost cells go on to infinity, as they hold what is
  /// outside; periodic directions are left out. Not above that of the particles in both.
  double distance2(Index cell, const Vec3& min, const Vec3& max) const {
    const auto k = unflatten(cell);
    double sum = 0;
    for (int c = 0; c < dim_; ++c) {
      if (period_[c] > 0) continue;
      const double width = 1 / inverse_width_[c], low = min_[c] + k[c] * width;
      const double below = k[c] > 0 ? low - max[c] : 0.0,
                   above = k[c] < count_[c] - 1 ? min[c] - (low + width) : 0.0;
      const double gap = std::max({0.0, below, above});
      sum += gap * gap;
    }
    return sum;
  }

  /// Calls f(cell) for the cells that a box touches (no periodic images).
  template <class F>
  void for_box(const Vec3& min, const Vec3& max, F&& f) const {
    std::array<Index, 3> low{0, 0, 0}, high{0, 0, 0};
    for (int c = 0; c < dim_; ++c) {
      low[c] = coordinate(c, min[c]);
      high[c] = coordinate(c, max[c]);
    }
    for (Index x = low[0]; x <= high[0]; ++x)
      for (Index y = low[1]; y <= high[1]; ++y)
        for (Index z = low[2]; z <= high[2]; ++z) f(flat({x, y, z}));
  }

 private:
  Index wrap(int c, Index k) const { return k < 0 ? k + count_[c] : k >= count_[c] ? k - count_[c] : k; }
  Index coordinate(int c, double x) const {
    double s = (x - min_[c]) * inverse_width_[c];
    if (period_[c] > 0) s -= count_[c] * std::floor(s / count_[c]);
    // Written so that NaN lands in cell 0: the check of the state finds it, not a wild index.
    if (!(s > 0)) return 0;
    return s < count_[c] ? static_cast<Index>(s) : count_[c] - 1;
  }

  int dim_ = 3;
  std::array<double, 3> min_{}, inverse_width_{}, period_{};
  std::array<Index, 3> count_{1, 1, 1};
};

}  // namespace meltray
