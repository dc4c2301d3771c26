// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/scene/scene.hpp"

namespace meltray::scene {

/// Corners of the box around a body [m].
struct Bounds {
  Vec3 min, max;
};
inline Bounds bounds_of(const Body& body) {
  if (body.shape == ShapeKind::box) return {body.min, body.max};
  return {body.center - body.radii, body.center + body.radii};
}

}  // namespace meltray::scene
