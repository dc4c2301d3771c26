// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/sph/lattice.hpp"

namespace meltray::terms {

/// Differences see half of a gradient across a flat face. With the surface pressure q on the face, half a
/// spacing above the outermost layer, the other half is (p - q) grad c times this, for sums V grad W as they
/// are: 2 but for what those of the lattice are off.
inline double surface_part(const sph::LatticeSums& lattice) {
  return 2 / lattice.face_gradient;
}

}  // namespace meltray::terms
