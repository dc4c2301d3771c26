// SPDX-License-Identifier: MIT
#include "meltray/terms/artificial_viscosity.hpp"

#include <algorithm>

namespace meltray::terms {

void ArtificialViscosity::add_acceleration(const Stage& s, const MutField& acceleration) const {
  const double h = s.constants->smoothing, strength = alpha * sound_speed * h, softening = 0.01 * h * h;
  mass_.resize(s.size());
  parallel_for(s.size(), [&](Index i) {
    const int wall = s.patch->wall[i];
    mass_[i] = wall && !s.constants->faces[wall - 1].no_slip ? 0.0 : s.patch->mass[i];
  });
  const ConstField v = view(static_cast<const Patch*>(s.patch)->v);
  const double *const mass = mass_.data(), *const density = s.patch->density.data();
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t k) {
      const Index i = s.moving[k];
      const double rho = density[i];
      double vi[D];
      for (int c = 0; c < D; ++c) vi[c] = v[c][i];
      const auto sum = s.pairs->sum_row<D, D>(i, [&](const sph::Pair<D>& p) {
        double along = 0;
        for (int c = 0; c < D; ++c) along += (vi[c] - v[c][p.j]) * p.x[c];
        const double g =
            mass[p.j] * p.f * std::min(along, 0.0) / (0.5 * (rho + density[p.j]) * (p.r2() + softening));
        std::array<double, D> out;
        for (int c = 0; c < D; ++c) out[c] = g * p.x[c];
        return out;
      });
      for (int c = 0; c < D; ++c) acceleration[c][i] += strength * sum[c];
    });
  });
}

}  // namespace meltray::terms
