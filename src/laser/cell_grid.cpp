// SPDX-License-Identifier: MIT
#include "laser/cell_grid.hpp"

#include <algorithm>
#include <cmath>

namespace meltray::laser {

CellGrid::CellGrid(std::span<const Vec3> points, double size) : size_(size) {
  low_ = high_ = centre_ = Vec3::Zero();
  if (points.empty()) return;
  low_ = high_ = points.front();
  for (const Vec3& x : points) {
    low_ = low_.cwiseMin(x);
    high_ = high_.cwiseMax(x);
  }
  centre_ = 0.5 * (low_ + high_);
  const double most = 8.0 * static_cast<double>(points.size()) + 64;
  const auto cells = [&] { return ((high_ - low_) / size_ + Vec3::Ones()).prod(); };
  while (cells() > most) size_ *= 2;
  for (std::size_t a = 0; a < 3; ++a)
    n_[a] = static_cast<std::ptrdiff_t>((high_ - low_)[static_cast<int>(a)] / size_) + 1;

  const auto key = [&](const Vec3& x) {
    return static_cast<std::size_t>((cell(2, x.z()) * n_[1] + cell(1, x.y())) * n_[0] + cell(0, x.x()));
  };
  start_.assign(static_cast<std::size_t>(n_[0] * n_[1] * n_[2]) + 1, 0);
  for (const Vec3& x : points) ++start_[key(x) + 1];
  for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
  order_.resize(points.size());
  std::vector<std::size_t> cursor(start_.begin(), start_.end() - 1);
  sorted_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t place = cursor[key(points[i])]++;
    order_[place] = i;
    sorted_[place] = points[i];
  }
}

std::ptrdiff_t CellGrid::cell(std::size_t axis, double coordinate) const {
  const double c = std::floor((coordinate - low_[static_cast<int>(axis)]) / size_);
  return static_cast<std::ptrdiff_t>(std::clamp(c, 0.0, static_cast<double>(n_[axis] - 1)));
}

}  // namespace meltray::laser
