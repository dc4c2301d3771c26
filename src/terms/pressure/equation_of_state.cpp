// SPDX-License-Identifier: MIT
#include <algorithm>

#include "meltray/terms/pressure/weakly_compressible.hpp"

namespace meltray::terms {

double EquationOfState::reference_density(const SceneConstants& constants, double temperature) const {
  return expansion ? constants.material.density_of_t(temperature) : constants.density;
}

double EquationOfState::pressure(double excess, double reference) const {
  const double p = sound_speed * sound_speed * std::max(excess, -tear * reference);
  return tension == Tension::none ? std::max(p, 0.0) : p;
}

void EquationOfState::update(Stage& s) const {
  s.excess.resize(s.size());
  parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t k) {
    const Index i = s.moving[k];
    s.volume[i] = s.patch->mass[i] / s.patch->density[i];
    const double reference = reference_density(*s.constants, s.temperature[i]);
    s.excess[i] = s.patch->density[i] - reference;
    s.patch->pressure[i] = pressure(s.excess[i], reference);
  });
}

}  // namespace meltray::terms
