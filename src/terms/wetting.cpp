// SPDX-License-Identifier: MIT
#include <cmath>

#include "meltray/core/constants.hpp"
#include "meltray/terms/surface_forces.hpp"
#include "terms/solid_beside.hpp"

namespace meltray::terms {

namespace {

/// Wall colour (share of the Shepard sum that is solid) above which the normal is fully the triple-line one:
/// any particle but those at the end of the kernel's reach. With 0.2 the line stops twice as far from its
/// angle.
constexpr double kWallColourFull = 0.05;
/// Sine of the angle between surface and wall below which they are parallel, as of a film that covers its
/// solid and has no triple line, and above which they meet. Disorder tilts the normals of a resting film one
/// particle thick by less; turned however little they differ from the wall's, such a film runs at 0.4 to 2
/// m/s. Ramps up to 0.3 or 0.5 tear rims of 120 degrees apart.
constexpr double kParallel = 0.1, kAcross = 0.15;

}  // namespace

void Wetting::turn_normals(Stage& s) const {
  const double theta = contact_angle_deg * constants::pi / 180, sine = std::sin(theta),
               cosine = std::cos(theta);
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    const auto count = static_cast<std::ptrdiff_t>(s.moving.size());
    const double* const volume = s.volume.data();
    const std::uint8_t* const liquid = s.patch->liquid.data();
    for (int c = 0; c < D; ++c) s.wall_normal[c].assign(s.size(), 0.0);
    parallel_for(count, [&](std::ptrdiff_t k) {
      const Index i = s.moving[k];
      if (s.surface[i] == 0) return;
      const SolidBeside<D> wall = solid_beside<D>(
          s, i, [&](const sph::PairLanes<D>& p) { return (1 - p.of(liquid)) * p.of(volume); });
      if (wall.colour <= 0) return;
      const std::array<double, D>& nw = wall.into;
      double along = 0;
      for (int c = 0; c < D; ++c) along += s.normal[c][i] * nw[c];
      double tangent[D], length = 0;
      for (int c = 0; c < D; ++c) {
        tangent[c] = s.normal[c][i] - along * nw[c];
        length += tangent[c] * tangent[c];
      }
      length = std::sqrt(length);
      if (length <= kParallel) return;
      const double line = std::clamp((length - kParallel) / (kAcross - kParallel), 0.0, 1.0);
      const double share = line * std::min(wall.colour / kWallColourFull, 1.0);
      double mixed[D], size = 0;
      for (int c = 0; c < D; ++c) {
        const double prescribed = sine * tangent[c] / length - cosine * nw[c];
        s.wall_normal[c][i] = share * prescribed;
        mixed[c] = (1 - share) * s.normal[c][i] + share * prescribed;
        size += mixed[c] * mixed[c];
      }
      if (size < 1e-12) return;
      for (int c = 0; c < D; ++c) s.normal[c][i] = mixed[c] / std::sqrt(size);
    });
  });
}

}  // namespace meltray::terms
