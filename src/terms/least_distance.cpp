// SPDX-License-Identifier: MIT
#include "meltray/terms/least_distance.hpp"

#include <algorithm>
#include <cmath>

namespace meltray::terms {

void LeastDistance::displace(const Stage& s, double dt, const MutField& displacement) const {
  const double least = share * s.constants->spacing;
  // The geometry in the list is older by a step. A pair that has come nearer by more than this within it is
  // parted in the next.
  const double listed = least + 0.4 * s.constants->spacing;
  const double rate = std::min(dt / parting, 0.5);
  const Patch& patch = *s.patch;
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t k) {
      const Index i = s.moving[k];
      std::array<double, D> moved{};
      const auto part_from = [&](Index j) {
        const double at_surface = std::max(s.surface[i], s.surface[j]);
        if (at_surface == 0 || patch.wall[j]) return;
        std::array<double, D> x;
        double r2 = 0;
        for (int c = 0; c < D; ++c) {
          x[c] = s.pairs->nearest(c, patch.x[c][i] - patch.x[c][j]);
          r2 += x[c] * x[c];
        }
        if (!(r2 < least * least) || r2 == 0) return;
        const double r = std::sqrt(r2);
        const double own = patch.liquid[j] ? patch.mass[j] / (patch.mass[i] + patch.mass[j]) : 1.0;
        for (int c = 0; c < D; ++c) moved[c] += 0.5 * rate * at_surface * own * (least - r) / r * x[c];
      };
      s.pairs->template for_lanes<D>(i, [&](const sph::PairLanes<D>& p) {
        const auto near = p.r2() < listed * listed;
        if (none_of(near)) return;
        for (Index n = 0; n < sph::kLaneCount; ++n)
          if (near[n]) part_from(p.j[n]);
      });
      for (int c = 0; c < D; ++c) displacement[c][i] = moved[c];
    });
  });
}

}  // namespace meltray::terms
