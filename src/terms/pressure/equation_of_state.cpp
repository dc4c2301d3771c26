// SPDX-License-Identifier: MIT
#include <algorithm>

#include "meltray/terms/pressure/weakly_compressible.hpp"

namespace meltray::terms {

double EquationOfState::reference_density(const SceneConstants& constants, double temperature) const {
  return expansion ? constants.material.density_of_t(temperature) : constants.density;
}

double EquationOfState::pressure(double excess) const {
  const double p = sound_speed * sound_speed * excess;
  return tension == Tension::none ? std::max(p, 0.0) : p;
}

void EquationOfState::update(Stage& s) const {
  s.excess.resize(s.size());
  parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t k) {
    const Index i = s.moving[k];
    s.volume[i] = s.patch->mass[i] / s.patch->density[i];
    s.excess[i] = s.patch->density[i] - reference_density(*s.constants, s.temperature[i]);
    s.patch->pressure[i] = pressure(s.excess[i]);
  });
}

void EquationOfState::extrapolate(Stage& s) const {
  const auto& wall_of_melt = s.pairs->next_to_melt();
  const std::uint8_t* const liquid = s.patch->liquid.data();
  const double* const density = s.patch->density.data();
  double* const p = s.patch->pressure.data();
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    parallel_for(s.size(), [&](Index i) {
      if (!wall_of_melt[i]) return;
      const auto sum = s.pairs->sum_row<D, 2>(i, [&](const sph::Pair<D>& q) {
        const double w = liquid[q.j] ? q.w : 0.0;
        return std::array<double, 2>{w * (p[q.j] - density[q.j] * gravity * q.x[D - 1]), w};
      });
      const double mean = sum[1] > 0 ? sum[0] / sum[1] : 0.0;
      p[i] = tension == Tension::none ? std::max(mean, 0.0) : mean;
    });
  });
}

}  // namespace meltray::terms
