// SPDX-License-Identifier: MIT
#include "meltray/particles/cell_grid.hpp"

#include <algorithm>
#include <string>

#include "meltray/core/errors.hpp"

namespace meltray {

CellGrid::CellGrid(int dim, const Vec3& min, const Vec3& max, double width, std::array<bool, 3> periodic)
    : dim_(dim) {
  for (int c = 0; c < dim; ++c) {
    const double length = max[c] - min[c];
    count_[c] = std::max<Index>(1, static_cast<Index>(std::floor(length / width * (1 + 1e-12))));
    min_[c] = min[c];
    inverse_width_[c] = count_[c] / length;
    if (!periodic[c]) continue;
    period_[c] = length;
    if (count_[c] < 3)
      throw UsageError("a periodic box must be at least three support radii long: direction " +
                       std::to_string(c) + " has " + std::to_string(length) + " m, a support radius is " +
                       std::to_string(width) + " m");
  }
}

}  // namespace meltray
