// SPDX-License-Identifier: MIT
#include "app/validate/melting_strip.hpp"

#include <fmt/format.h>

#include <cmath>

namespace meltray::app {
namespace {

/// Where the solid starts at the melting point its temperature does not change and there is nothing to
/// compare.
void measure_profile(const scene::Simulation& simulation, const Neumann& exact, MeltedStrip& result) {
  const Particles& p = simulation.particles();
  const double t = simulation.time(), front = exact.front(t);
  double error[2] = {0, 0}, scale[2] = {0, 0};
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_wall(i)) continue;
    const double x = p.x[0][i], reference = exact.temperature(x, t);
    const int solid = x > front;
    const double base = solid ? exact.initial : exact.melting;
    error[solid] += std::pow(p.temperature[i] - reference, 2);
    scale[solid] += std::pow(reference - base, 2);
  }
  result.liquid = std::sqrt(error[0] / scale[0]);
  result.solid = scale[1] > 0 ? std::sqrt(error[1] / scale[1]) : 0.0;
}

}  // namespace

double melting_point(const Material& m) {
  return 0.5 * (m.solidus + m.liquidus);
}

Neumann neumann(const scene::Scene& scene, double initial) {
  const Material& m = scene.material;
  const double melting = melting_point(m);
  return {m.density,
          m.latent_heat_fusion,
          m.conductivity_liquid(melting),
          m.heat_capacity_liquid,
          m.conductivity_solid(melting),
          m.heat_capacity_solid,
          scene.domain.faces[0].temperature,
          melting,
          initial};
}

MeltedStrip melt_strip(const Setting& setting, double spacing, double end, scene::Overrides overrides) {
  const Watch watch;
  const double length = scene::read_case(setting.folder / "case.toml").domain.max[0];
  for (const std::string& size : strip(length, spacing)) overrides.push_back(size);
  overrides.push_back(fmt::format("time.end_s={}", end));
  const auto simulation = start(setting, overrides);
  advance(*simulation, end);
  const scene::Scene& scene = simulation->scene();
  const Particles& p = simulation->particles();
  MeltedStrip result;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (!p.is_wall(i))
      result.front += scene.material.liquid_fraction(p.h[i]) * p.mass[i] /
                      (scene.material.density * strip_height(spacing));
  const double initial = scene.domain.bodies[0].temperature;
  const Neumann exact =
      neumann(scene, initial < scene.material.solidus ? initial : melting_point(scene.material));
  result.exact_front = exact.front(end);
  measure_profile(*simulation, exact, result);
  result.budget = simulation->energy().relative_error();
  result.steps = simulation->counters().steps;
  result.seconds = watch.seconds();
  result.spacing = spacing;
  return result;
}

}  // namespace meltray::app
