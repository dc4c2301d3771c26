// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

#include "meltray/scene/scene.hpp"

namespace meltray::scene {

/// Layers of the lattice along one axis of the box. Where its length is no multiple of the spacing they are
/// spread evenly over it.
inline std::int64_t layers_along(const Domain& domain, int axis) {
  return std::llround((domain.max[axis] - domain.min[axis]) / domain.spacing);
}

/// Distance of these layers [m].
inline double layer_height(const Domain& domain, int axis) {
  return (domain.max[axis] - domain.min[axis]) / static_cast<double>(layers_along(domain, axis));
}

}  // namespace meltray::scene
