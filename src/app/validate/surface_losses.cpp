// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "app/validate/half_space.hpp"
#include "app/validate/scenes.hpp"
#include "meltray/core/constants.hpp"

namespace meltray::app {
namespace {

using constants::pi, constants::gas_constant, constants::stefan_boltzmann, constants::standard_atmosphere;

/// One way to lose heat, over the time in which it cools the surface by some hundred kelvin.
struct Loss {
  std::string name;
  scene::Overrides overrides;
  double time;                                                          ///< [s]
  std::vector<double> spacings;                                         ///< coarse to fine [m]
  std::function<double(const scene::Scene&, double temperature)> flux;  ///< [W/m^2]
};

/// Hertz-Knudsen: (1 - beta_r) p_sat(T) sqrt(M / (2 pi R T)) L_v, p_sat after Clausius and Clapeyron.
double evaporation(const scene::Scene& scene, double t) {
  const Material& m = scene.material;
  const double pressure = standard_atmosphere * std::exp(m.latent_heat_vaporisation * m.molar_mass /
                                                         gas_constant * (1 / m.boiling_temperature - 1 / t));
  return scene.surface.evaporation_coefficient * pressure *
         std::sqrt(m.molar_mass / (2 * pi * gas_constant * t)) * m.latent_heat_vaporisation;
}

double radiation(const scene::Scene& scene, double t) {
  return scene.material.emissivity * stefan_boltzmann *
         (std::pow(t, 4) - std::pow(scene.surface.ambient_temperature, 4));
}

struct Cooled {
  double lost = 0, expected_lost = 0;  ///< [J/m^2]
  double fall = 0, expected_fall = 0;  ///< of the surface temperature [K]
  double budget = 0, seconds = 0;
};

/// place: surface.temperature.
Cooled run(const Setting& setting, const Loss& loss, const char* place, double spacing) {
  const Watch watch;
  const Material& m = scene::read_case(setting.folder / "case.toml").material;
  const double conductivity = m.conductivity_liquid(m.boiling_temperature),
               stored = m.density * m.heat_capacity_liquid;
  const double length = std::ceil(6 * std::sqrt(conductivity / stored * loss.time) / spacing) * spacing;
  scene::Overrides all = strip(length, spacing);
  all.insert(all.end(), loss.overrides.begin(), loss.overrides.end());
  all.push_back(fmt::format("time.end_s={}", loss.time));
  all.push_back(fmt::format("surface.temperature=\"{}\"", place));
  const auto simulation = start(setting, all);
  advance(*simulation, loss.time);
  const scene::Scene& scene = simulation->scene();
  const double initial = scene.domain.bodies[0].temperature;
  const CooledHalfSpace exact = cool_half_space(std::sqrt(conductivity * stored), initial, loss.time, 4000,
                                                [&](double t) { return loss.flux(scene, t); });
  const scene::EnergyBudget energy = simulation->energy();
  return {(energy.evaporation + energy.radiation) / strip_height(spacing),
          exact.lost,
          initial - surface_temperature(simulation->particles(), spacing),
          initial - exact.surface,
          energy.relative_error(),
          watch.seconds()};
}

}  // namespace

Rows surface_losses(const Setting& setting) {
  const std::vector<double> fine = setting.small ? std::vector<double>{1.25e-5, 6.25e-6}
                                                 : std::vector<double>{5e-5, 2.5e-5, 1.25e-5, 6.25e-6};
  std::vector<double> wide;  // radiation at 3200 K takes a thousand times as long to cool the surface as much
  for (const double spacing : fine) wide.push_back(20 * spacing);
  const std::vector<Loss> losses = {
      {"evaporation", {}, 1e-3, fine, evaporation},
      {"radiation", {"terms.evaporation=false", "terms.radiation=true"}, 1, wide, radiation}};
  Rows rows;
  for (const Loss& loss : losses)
    for (const auto& [place, line] : {std::pair{"particle", 0.03}, {"face", 0.01}}) {
      const std::string name = fmt::format("{}, T of the {}: ", loss.name, place);
      Rows lost, fall, budgets;
      for (const double spacing : loss.spacings) {
        const Cooled c = run(setting, loss, place, spacing);
        const Measured how{resolution_text(spacing), c.seconds, "Duhamel's integral of the flux q(T)"};
        lost.push_back(relative_row(name + "heat lost [J/m2]", c.lost, c.expected_lost, line, how));
        fall.push_back(
            relative_row(name + "fall of the surface temperature [K]", c.fall, c.expected_fall, line, how));
        budgets.push_back(limit_row(name + "heat taken from the metal = heat lost", c.budget, 1e-10, how));
      }
      add_series(rows, loss.spacings, lost);
      add_series(rows, loss.spacings, fall);
      rows.insert(rows.end(), budgets.begin(), budgets.end());
    }
  return rows;
}

}  // namespace meltray::app
