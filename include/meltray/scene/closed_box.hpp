// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/scene/scene.hpp"

namespace meltray::scene {

/// No face of the box is open: all are walls or periodic. Faces in y do not exist in 2-D.
inline bool is_closed(const Domain& domain) {
  for (int f = 0; f < 6; ++f)
    if ((domain.dimension == 3 || f / 2 != 1) && domain.faces[f].kind == FaceKind::free) return false;
  return true;
}

}  // namespace meltray::scene
