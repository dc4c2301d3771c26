// SPDX-License-Identifier: MIT
#include "app/validate/scenes.hpp"

#include <fmt/format.h>

#include <cmath>

#include "meltray/core/constants.hpp"

namespace meltray::app {

std::unique_ptr<scene::Simulation> start(const Setting& setting, const scene::Overrides& overrides,
                                         const std::string& file) {
  return std::make_unique<scene::Simulation>(scene::read_case(setting.folder / file, overrides));
}

std::vector<Model> collapse_models() {
  return {{"wcsph", {}},
          {"isph", {"flow.solver=isph", "terms.artificial_viscosity=false", "flow.shifting=4"}}};
}

double strip_height(double spacing) {
  return 12 * spacing;
}

scene::Overrides strip(double length, double spacing) {
  const double height = strip_height(spacing);
  return {fmt::format("domain.spacing_m={}", spacing), fmt::format("domain.max_m=[{},{}]", length, height),
          fmt::format("bodies.0.max_m=[{},{}]", length, height)};
}

double smoothing_length(const scene::Scene& scene) {
  return scene.domain.smoothing_ratio * scene.domain.spacing;
}

void advance(scene::Simulation& simulation, double end, const std::function<void()>& watch) {
  while (simulation.time() < end) {
    simulation.step(end);
    if (watch) watch();
  }
}

double rms_speed(const Particles& p) {
  double energy = 0, mass = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.is_liquid(i) || p.is_wall(i) || p.has(i, kRemoved)) continue;
    for (int c = 0; c < p.dim; ++c) energy += p.mass[i] * p.v[c][i] * p.v[c][i];
    mass += p.mass[i];
  }
  return mass > 0 ? std::sqrt(energy / mass) : 0.0;
}

double equivalent_radius(const Particles& p, double density) {
  double volume = 0;
  for (std::size_t i = 0; i < p.size(); ++i) volume += p.mass[i] / density;
  return p.dim == 2 ? std::sqrt(volume / constants::pi) : std::cbrt(0.75 * volume / constants::pi);
}

std::string resolution_text(double spacing) {
  if (spacing < 1e-3) return fmt::format("dx {:.4g} um", spacing * 1e6);
  return fmt::format("dx {:.4g}", spacing);
}

}  // namespace meltray::app
