// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/core/vec.hpp"
#include "meltray/laser/laser.hpp"
#include "meltray/particles/particles.hpp"

namespace meltray::observe {

/// Where to look for the void: lateral range and depth range of the voxel grid [m]. In 2-D the y range is
/// ignored. `max[2]` must lie in the open space above the melt: the void is flooded from there.
struct VoidRegion {
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();
};

/// Depth below z = 0 of the void that is connected to the space above [m].
///
/// Definition. On voxels of half a spacing the metal (solid, liquid and wall particles) is smoothed to a
/// volume fraction, phi(x) = sum_j V_j w(|x - x_j|), w = c (1 - r/R)^2, R = 1.5 spacings, integral of w = 1;
/// metal is where phi >= 1/2. Pieces of metal that touch neither solid nor the side or bottom of the region
/// are drops in flight and count as void. The void is flooded over faces from the top layer; its lowest
/// point, refined by where phi crosses 1/2 below the lowest voxel, is the depth. Slits narrower than about a
/// spacing are closed.
double void_depth(const Particles& p, double spacing, const VoidRegion& region);

/// Depth below z = 0 of the deepest first hit of the beam's axis bundle on the tracer's surface [m]. Where
/// every ray of the bundle passes through, `thickness` (full penetration); without a surface, 0.
double axis_depth(const laser::Tracer& tracer, const laser::Beam& beam, double t, double spacing,
                  double thickness);

/// Loose or bridging melt hides the ground: the void reaches more than three spacings below what the beam
/// sees.
inline bool capillary_closed(double void_depth, double axis_depth, double spacing) {
  return void_depth - axis_depth > 3 * spacing;
}

}  // namespace meltray::observe
