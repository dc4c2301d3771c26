// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

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
    for (int c = 0; c < dim_; ++c) std::tie(low[c], high[c]) = block(c, k[c], reach);
    for (Index x = low[0]; x <= high[0]; ++x)
      for (Index y = low[1]; y <= high[1]; ++y)
        for (Index z = low[2]; z <= high[2]; ++z) f(flat({wrap(0, x), wrap(1, y), wrap(2, z)}));
  }

  /// Calls f(cell) for the cells within `reach` cells of `centre` that are no farther than `far` [m] from a
  /// box in it. The outermost cells go on to infinity, as they hold what is outside; periodic directions
  /// count as no distance.
  template <class F>
  void for_near(Index centre, Index reach, double far, const Vec3& min, const Vec3& max, F&& f) const {
    const auto k = unflatten(centre);
    std::array<Index, 3> low{0, 0, 0}, high{0, 0, 0};
    for (int c = 0; c < dim_; ++c) std::tie(low[c], high[c]) = block(c, k[c], reach);
    const auto gap2 = [&](int c, Index n) {
      const double g = c < dim_ && period_[c] == 0 ? gap(c, n, min[c], max[c]) : 0.0;
      return g * g;
    };
    for (Index x = low[0]; x <= high[0]; ++x) {
      const double of_x = gap2(0, x);
      for (Index y = low[1]; y <= high[1]; ++y) {
        const double of_xy = of_x + gap2(1, y);
        for (Index z = low[2]; z <= high[2]; ++z)
          if (of_xy + gap2(2, z) <= far * far) f(flat({wrap(0, x), wrap(1, y), wrap(2, z)}));
      }
    }
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
  /// First and last cell of a block along one direction, before they are wrapped.
  std::pair<Index, Index> block(int c, Index k, Index reach) const {
    if (period_[c] == 0) return {std::max<Index>(k - reach, 0), std::min<Index>(k + reach, count_[c] - 1)};
    if (2 * reach + 1 > count_[c]) return {0, count_[c] - 1};
    return {k - reach, k + reach};
  }
  /// Distance of a stretch from cell k along one direction [m].
  double gap(int c, Index k, double min, double max) const {
    const double width = 1 / inverse_width_[c], low = min_[c] + k * width;
    const double below = k > 0 ? low - max : 0.0, above = k < count_[c] - 1 ? min - (low + width) : 0.0;
    return std::max({0.0, below, above});
  }
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
