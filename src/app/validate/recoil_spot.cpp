// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "app/validate/scenes.hpp"
#include "meltray/core/constants.hpp"

namespace meltray::app {
namespace {

double kinetic_energy(const Particles& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i)
    for (int c = 0; c < 2; ++c) sum += 0.5 * p.mass[i] * p.v[c][i] * p.v[c][i];
  return sum;
}

/// Kinetic energy of potential flow that a pressure q(x) = q_0 exp(-2 x^2 / R^2), its integral over time
/// being `impulse` q / q_0, starts from rest in a pool of depth H between walls at x = -L and L: velocities
/// are grad P / rho, P the harmonic function that is the integral of q on the surface and has no slope on
/// floor and walls. With the cosines q_n of q / q_0, k_n = n pi / L: E = impulse^2 L / (2 rho) sum_n k_n
/// tanh(k_n H) q_n^2 [J/m].
double energy_of_potential_flow(const scene::Scene& scene, double impulse, double depth) {
  const double half = scene.domain.max[0], radius = scene.surface.recoil_radius;
  constexpr int kModes = 60, kPoints = 4000;
  double sum = 0;
  for (int n = 1; n <= kModes; ++n) {
    const double k = n * constants::pi / half;
    double mode = 0;
    for (int m = 0; m < kPoints; ++m) {
      const double x = half * (m + 0.5) / kPoints;
      mode += 2.0 / kPoints * std::exp(-2 * x * x / (radius * radius)) * std::cos(k * x);
    }
    sum += k * std::tanh(k * depth) * mode * mode;
  }
  return impulse * impulse * half / (2 * scene.material.density) * sum;
}

struct Spot {
  double energy = 0, reference = 0, seconds = 0;
};

Spot run(const Setting& setting, scene::Overrides overrides, double spacing, double depth) {
  const Watch watch;
  overrides.insert(overrides.end(), {fmt::format("domain.spacing_m={}", spacing),
                                     fmt::format("domain.min_m=[-1.2e-3,{}]", -depth),
                                     fmt::format("bodies.0.min_m=[-1.2e-3,{}]", -depth)});
  const auto simulation = start(setting, overrides);
  const scene::Scene& scene = simulation->scene();
  const double end = scene.time.end;
  advance(*simulation, end);
  const double impulse = scene.surface.recoil_pressure * (end - 0.5 * scene.surface.recoil_ramp);
  return {kinetic_energy(simulation->particles()), energy_of_potential_flow(scene, impulse, depth),
          watch.seconds()};
}

/// Kinetic energy [J/m] of a pool that a narrower spot of three times the pressure has dug into.
double crater_energy(const Setting& setting, scene::Overrides overrides, double spacing) {
  overrides.insert(overrides.end(),
                   {fmt::format("domain.spacing_m={}", spacing), "surface.recoil_pressure_pa=150e3",
                    "surface.recoil_radius_m=2e-4", "terms.viscosity=true", "terms.surface_tension=true",
                    "time.end_s=1.25e-4"});
  const auto simulation = start(setting, overrides);
  advance(*simulation, simulation->scene().time.end);
  return kinetic_energy(simulation->particles());
}

/// Both solvers have to dig the same crater. Weakly compressible melt does so where it keeps its tension as
/// it is; without it stretched melt comes apart, and the repulsion of Monaghan 2000 feeds energy to it.
void add_craters(const Setting& setting, const scene::Overrides& weak, double spacing, Rows& rows) {
  const double projected = crater_energy(setting, {}, spacing);
  for (const char* tension : {"full", "none", "artificial_stress"}) {
    const Watch watch;
    scene::Overrides overrides = weak;
    overrides.push_back(fmt::format("flow.tension={}", tension));
    const double energy = crater_energy(setting, overrides, spacing);
    rows.push_back(relative_row(fmt::format("wcsph, crater, tension {}: kinetic energy [J/m]", tension),
                                energy, projected, 0.1, {resolution_text(spacing), watch.seconds(), "ISPH"}));
    rows.back().judged = tension == std::string("full");
  }
}

}  // namespace

Rows recoil_spot(const Setting& setting) {
  const scene::Overrides weak = {"flow.solver=wcsph", "flow.sound_speed_m_s=140"};
  scene::Overrides sums = weak;
  sums.push_back("flow.pressure_gradient=sum");
  struct Entry {
    const char* name;
    scene::Overrides overrides;
    double tolerance;
  };
  const std::vector<Entry> entries = {{"csf", {"surface.entry=csf"}, 0.02},
                                      {"pressure", {"surface.entry=pressure"}, 0.1},
                                      {"wcsph", weak, 0.05},
                                      {"wcsph, sums", sums, 0.05}};
  const std::vector<double> spacings =
      setting.small ? std::vector<double>{2.5e-5} : std::vector<double>{1e-4, 5e-5, 2.5e-5};
  Rows rows;
  for (const Entry& entry : entries)
    for (const auto& [name, depth] : {std::pair{"film of 0.1 mm", 1e-4}, {"pool of 0.6 mm", 6e-4}}) {
      Rows energies;
      for (const double spacing : spacings) {
        const Spot spot = run(setting, entry.overrides, spacing, depth);
        energies.push_back(relative_row(fmt::format("{}, {}: kinetic energy [J/m]", entry.name, name),
                                        spot.energy, spot.reference, entry.tolerance,
                                        {resolution_text(spacing), spot.seconds, "potential flow"}));
      }
      add_series(rows, spacings, energies);
    }
  for (const double spacing : setting.small ? std::vector<double>{5e-5} : std::vector<double>{5e-5, 2.5e-5})
    add_craters(setting, weak, spacing, rows);
  return rows;
}

}  // namespace meltray::app
