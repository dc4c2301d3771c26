// SPDX-License-Identifier: MIT
#include "meltray/terms/evaporation.hpp"

#include <cmath>

#include "meltray/core/constants.hpp"

namespace meltray::terms {

using constants::gas_constant;
using constants::stefan_boltzmann;

double SurfaceLosses::mass_flux(const Material& m, double temperature) const {
  return coefficient * m.saturation_pressure(temperature) *
         std::sqrt(m.molar_mass / (2 * constants::pi * gas_constant * temperature));
}

double SurfaceLosses::mass_flux_slope(const Material& m, double temperature) const {
  const double root = std::sqrt(m.molar_mass / (2 * constants::pi * gas_constant * temperature));
  return coefficient * root *
         (m.saturation_pressure_slope(temperature) - 0.5 * m.saturation_pressure(temperature) / temperature);
}

void SurfaceLosses::add_heating(const Stage& s, double* heating, Crossings& crossings) const {
  const Material& m = s.constants->material;
  struct Sum {
    double evaporation, radiation, mass;
  };
  const Sum total = parallel_reduce(
      static_cast<std::ptrdiff_t>(s.heated.size()), Sum{0, 0, 0},
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Sum sum{0, 0, 0};
        for (std::ptrdiff_t k = begin; k < end; ++k) {
          const Index i = s.heated[k];
          if (s.area[i] == 0) continue;
          const double t = s.temperature[i];
          double loss = 0;
          if (evaporation && s.patch->liquid[i]) {
            const double rate = s.area[i] * mass_flux(m, t);
            sum.mass += rate;
            sum.evaporation += rate * m.latent_heat_vaporisation;
            loss += rate * m.latent_heat_vaporisation;
          }
          if (radiation) {
            const double q = s.area[i] * m.emissivity * stefan_boltzmann *
                             (t * t * t * t - std::pow(ambient_temperature, 4));
            sum.radiation += q;
            loss += q;
          }
          heating[i] -= loss / s.patch->mass[i];
        }
        return sum;
      },
      [](Sum a, Sum b) {
        return Sum{a.evaporation + b.evaporation, a.radiation + b.radiation, a.mass + b.mass};
      });
  crossings.evaporation += total.evaporation;
  crossings.radiation += total.radiation;
  crossings.evaporated_mass += total.mass;
}

void SurfaceLosses::slope(const Stage& s, double* slope) const {
  const Material& m = s.constants->material;
  parallel_for(s.size(), [&](Index i) {
    slope[i] = 0;
    if (s.area[i] == 0 || !s.heat[i]) return;
    const double t = s.temperature[i];
    if (evaporation && s.patch->liquid[i])
      slope[i] -= s.area[i] * m.latent_heat_vaporisation * std::max(0.0, mass_flux_slope(m, t));
    if (radiation) slope[i] -= s.area[i] * 4 * m.emissivity * stefan_boltzmann * t * t * t;
  });
}

double SurfaceLosses::rate(const Stage& s) const {
  const Material& m = s.constants->material;
  return parallel_max(static_cast<std::ptrdiff_t>(s.heated.size()), 0.0, [&](std::ptrdiff_t k) {
    const Index i = s.heated[k];
    if (s.area[i] == 0) return 0.0;
    const double t = s.temperature[i];
    double slope = 0;
    if (evaporation && s.patch->liquid[i])
      slope += s.area[i] * m.latent_heat_vaporisation * mass_flux_slope(m, t);
    if (radiation) slope += s.area[i] * 4 * m.emissivity * stefan_boltzmann * t * t * t;
    return slope / s.patch->mass[i] * m.temperature_slope(s.patch->h[i]);
  });
}

}  // namespace meltray::terms
