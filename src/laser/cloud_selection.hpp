// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "meltray/laser/laser.hpp"

namespace meltray::laser {

/// Particles that shape the surface in a region, with the mirror images that continue cut metal.
struct CloudSelection {
  std::vector<Vec3> position;
  std::vector<std::uint8_t> liquid;
  Box bounds;  ///< of the real particles; empty selection: undefined
};

/// Finite particles of the cloud inside `region` or up to `margin` outside. Where the cloud ends at a side or
/// bottom face of the region or less than three layers beyond (the metal was cropped there), the layers
/// before the face are mirrored, so that the crop is not taken for a free surface. The top is where the light
/// comes from and is always free.
CloudSelection select_cloud(const PointCloud& cloud, const Box& region, double margin);

}  // namespace meltray::laser
