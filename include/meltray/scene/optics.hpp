// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <string_view>

#include "meltray/scene/scene.hpp"

namespace meltray::scene {

/// Refractive indices that the laser of a scene meets, after `laser.optics`.
struct LaserIndex {
  std::complex<double> solid, liquid;
};
/// A hot melt whose index is not known counts as any melt (the case reader refuses that choice).
LaserIndex laser_index(const Scene& scene);

/// The word of the case file.
std::string_view name_of(Optics optics);

}  // namespace meltray::scene
