// SPDX-License-Identifier: MIT
#include "meltray/scene/memory_needed.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "meltray/core/errors.hpp"

namespace meltray::scene {

namespace {

/// Of a particle that sleeps, once more while a checkpoint is written [bytes].
constexpr double kBytesPerParticle = 180;

/// Fewest particles of a scene, told without laying them out: sites in the largest box that one of its bodies
/// holds inside the domain.
double least_count(const Domain& domain) {
  double most = 0;
  for (const Body& b : domain.bodies) {
    double count = 1;
    for (int c = 0; c < domain.dimension; ++c) {
      const double half = b.radii[c] / std::sqrt(domain.dimension);  // of the box inscribed in a ball
      const bool box = b.shape == ShapeKind::box;
      const double low = box ? b.min[c] : b.center[c] - half, high = box ? b.max[c] : b.center[c] + half;
      count *= std::max(0.0, std::min(high, domain.max[c]) - std::max(low, domain.min[c])) / domain.spacing;
    }
    most = std::max(most, count);
  }
  return most;
}

}  // namespace

void refuse_more_than_memory_holds(const Scene& scene) {
  const Domain& d = scene.domain;
  const double count = least_count(d), needed = kBytesPerParticle * count;
  const double held =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (needed < held) return;
  throw UsageError(fmt::format(
      "domain.spacing_m: found {:g}, at least {:.3g} particles that take {:.3g} GB of memory; allowed: a "
      "spacing of "
      "{:.2g} m or more with the {:.3g} GB of this machine",
      d.spacing, count, needed / 1e9, d.spacing * std::pow(needed / held, 1.0 / d.dimension), held / 1e9));
}

}  // namespace meltray::scene
