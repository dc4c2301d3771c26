// SPDX-License-Identifier: MIT
#include "meltray/terms/evaporation.hpp"

#include <cmath>
#include <limits>

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

double SurfaceLosses::radiated(const Material& m, double area, double t) const {
  return area * m.emissivity * stefan_boltzmann * (t * t * t * t - std::pow(ambient_temperature, 4));
}

double SurfaceLosses::flux(const Stage& s, Index i, double t) const {
  const Material& m = s.constants->material;
  double q = 0;
  if (evaporation && s.patch->liquid[i]) q += mass_flux(m, t) * m.latent_heat_vaporisation;
  if (radiation) q += radiated(m, 1, t);
  return q;
}

double SurfaceLosses::flux_slope(const Stage& s, Index i, double t) const {
  const Material& m = s.constants->material;
  double slope = 0;
  if (evaporation && s.patch->liquid[i])
    slope += m.latent_heat_vaporisation * std::max(0.0, mass_flux_slope(m, t));
  if (radiation) slope += 4 * m.emissivity * stefan_boltzmann * t * t * t;
  return slope;
}

namespace {

/// Conductance between a particle's centre and its face [W/(m^2 K)].
double conductance(const Stage& s, Index i) {
  const double layer = std::min(s.volume[i] / s.area[i], s.constants->spacing);
  return 2 * s.constants->material.conductivity(s.patch->h[i]) / layer;
}

constexpr double kFaceTolerance = 1e-3;  // [K]
constexpr int kFaceIterations = 60;

}  // namespace

/// Temperature at which vapour alone carries a flux away [K]: of Hertz and Knudsen's flux that of the boiling
/// point with Clausius and Clapeyron's exponential, which is right but for a root of T.
double SurfaceLosses::temperature_of_vapour(const Material& m, double absorbed) const {
  const double boiling = m.boiling_temperature,
               at_boiling = mass_flux(m, boiling) * m.latent_heat_vaporisation;
  const double inverse = 1 / boiling - gas_constant / (m.latent_heat_vaporisation * m.molar_mass) *
                                           std::log(absorbed / at_boiling);
  return inverse > 0 ? 1 / inverse : std::numeric_limits<double>::infinity();
}

void SurfaceLosses::find_faces(Stage& s, const std::vector<double>& light) const {
  s.face_temperature = s.temperature;
  parallel_for(static_cast<std::ptrdiff_t>(s.heated.size()), [&](std::ptrdiff_t k) {
    const Index i = s.heated[k];
    if (s.area[i] == 0 || !s.patch->liquid[i]) return;
    const double g = conductance(s, i), inside = s.temperature[i],
                 absorbed = light.empty() ? 0.0 : light[i] / s.area[i];
    // From the lower of what conduction and vapour alone would give, which is near. The residual grows with
    // T_s and is convex: wherever it starts, Newton's method is above the root after one step and falls to
    // it.
    double t = inside + absorbed / g;
    if (evaporation && absorbed > 0)
      t = std::min(t, std::max(inside, temperature_of_vapour(s.constants->material, absorbed)));
    for (int iteration = 0; iteration < kFaceIterations; ++iteration) {
      const double step = (g * (t - inside) + flux(s, i, t) - absorbed) / (g + flux_slope(s, i, t));
      t -= step;
      if (std::abs(step) < kFaceTolerance) break;
    }
    s.face_temperature[i] = t;
  });
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
          const double t = s.surface_temperature(i);
          double loss = 0;
          if (evaporation && s.patch->liquid[i]) {
            const double rate = s.area[i] * mass_flux(m, t);
            sum.mass += rate;
            sum.evaporation += rate * m.latent_heat_vaporisation;
            loss += rate * m.latent_heat_vaporisation;
          }
          if (radiation) {
            const double q = radiated(m, s.area[i], t);
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

/// d(power)/dT of a surface particle [W/K]: a face follows its particle by g / (g + q').
double SurfaceLosses::slope_of(const Stage& s, Index i) const {
  const double slope = flux_slope(s, i, s.surface_temperature(i));
  if (s.face_temperature.empty() || !s.patch->liquid[i]) return -s.area[i] * slope;
  const double g = conductance(s, i);
  return -s.area[i] * slope * g / (g + slope);
}

void SurfaceLosses::slope(const Stage& s, double* slope) const {
  parallel_for(s.size(), [&](Index i) { slope[i] = s.area[i] == 0 || !s.heat[i] ? 0.0 : slope_of(s, i); });
}

double SurfaceLosses::rate(const Stage& s) const {
  return parallel_max(static_cast<std::ptrdiff_t>(s.heated.size()), 0.0, [&](std::ptrdiff_t k) {
    const Index i = s.heated[k];
    if (s.area[i] == 0) return 0.0;
    return -slope_of(s, i) / s.patch->mass[i] * s.constants->material.temperature_slope(s.patch->h[i]);
  });
}

}  // namespace meltray::terms
