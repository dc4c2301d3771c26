// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "meltray/laser/laser.hpp"

namespace meltray::laser {

/// Numbers the cubes of edge `edge` in which hits lie, along x first.
class Cubes {
 public:
  Cubes(std::span<const Hit> hits, double edge) : edge_(edge) {
    for (const Hit& hit : hits) lowest_ = lowest_.cwiseMin(at(hit.position));
  }

  /// Corner of the cube around x, in edges.
  Vec3 at(const Vec3& x) const { return (x / edge_).array().floor(); }
  Vec3 centre(const Vec3& x) const { return edge_ * (at(x) + Vec3::Constant(0.5)); }

  std::uint64_t number(const Vec3& x) const {
    // Twenty-one bits of an axis are enough for two million cubes; what is farther is only not sorted.
    const Vec3 cube = (at(x) - lowest_).cwiseMin((1 << 21) - 1);
    return static_cast<std::uint64_t>(cube.z()) << 42 | static_cast<std::uint64_t>(cube.y()) << 21 |
           static_cast<std::uint64_t>(cube.x());
  }

 private:
  double edge_;
  Vec3 lowest_ = Vec3::Constant(std::numeric_limits<double>::infinity());
};

}  // namespace meltray::laser
