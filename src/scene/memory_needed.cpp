// SPDX-License-Identifier: MIT
#include "meltray/scene/memory_needed.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "meltray/core/errors.hpp"
#include "meltray/scene/body_bounds.hpp"

namespace meltray::scene {

namespace {

/// Of a particle that sleeps, once more while a checkpoint is written [bytes].
constexpr double kBytesPerParticle = 180;

/// Fewest particles of a scene, told without laying them out: sites in the largest box that one of its bodies
/// holds inside the domain.
double least_count(const Domain& domain) {
  double most = 0;
  for (const Body& b : domain.bodies) {
    const auto [min, max] = bounds_of(b);
    const double inscribed = b.shape == ShapeKind::box ? 1 : 1 / std::sqrt(domain.dimension);
    double count = 1;
    for (int c = 0; c < domain.dimension; ++c) {
      const double middle = 0.5 * (min[c] + max[c]), half = 0.5 * inscribed * (max[c] - min[c]);
      const double low = std::max(middle - half, domain.min[c]),
                   high = std::min(middle + half, domain.max[c]);
      count *= std::max(0.0, high - low) / domain.spacing;
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
