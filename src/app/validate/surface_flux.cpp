// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "app/validate/half_space.hpp"
#include "app/validate/scenes.hpp"
#include "meltray/core/constants.hpp"

namespace meltray::app {
namespace {

struct Metal {
  const char* name;
  double conductivity, density, capacity;
};

/// Rise of the surface, its error and the balance at one time.
struct Instant {
  double rise = 0, budget = 0, seconds = 0;
};

std::vector<Instant> run(const Setting& setting, const Metal& metal, double spacing,
                         const std::vector<double>& times) {
  const Watch watch;
  const double length = 6 * std::sqrt(metal.conductivity / (metal.density * metal.capacity) * times.back());
  const double whole = std::ceil(length / spacing) * spacing;
  scene::Overrides overrides = strip(whole, spacing);
  overrides.insert(overrides.end(), {fmt::format("material.conductivity_solid_w_m_k={}", metal.conductivity),
                                     fmt::format("material.density_kg_m3={}", metal.density),
                                     fmt::format("material.heat_capacity_solid_j_kg_k={}", metal.capacity)});
  const auto simulation = start(setting, overrides);
  std::vector<Instant> instants;
  for (const double t : times) {
    advance(*simulation, t);
    instants.push_back({surface_temperature(simulation->particles(), spacing) -
                            simulation->scene().domain.bodies[0].temperature,
                        simulation->energy().relative_error(), watch.seconds()});
  }
  return instants;
}

}  // namespace

Rows surface_flux(const Setting& setting) {
  const std::vector<Metal> metals = {{"Fe", 34, 7500, 690}, {"Al", 220, 2600, 1000}};
  const std::vector<double> times =
      setting.small ? std::vector<double>{1e-5, 1e-4} : std::vector<double>{1e-5, 1e-4, 1e-3};
  const std::vector<double> spacings =
      setting.small ? std::vector<double>{2e-5, 1e-5} : std::vector<double>{2e-5, 1e-5, 5e-6};
  const double flux = scene::read_case(setting.folder / "case.toml").domain.faces[0].flux;
  Rows rows;
  for (const Metal& metal : metals) {
    std::vector<std::vector<Instant>> runs;
    for (const double spacing : spacings) runs.push_back(run(setting, metal, spacing, times));
    const double diffusivity = metal.conductivity / (metal.density * metal.capacity);
    for (std::size_t k = 0; k < times.size(); ++k) {
      const double rise = 2 * flux / metal.conductivity * std::sqrt(diffusivity * times[k] / constants::pi);
      Rows series;
      for (std::size_t r = 0; r < spacings.size(); ++r) {
        series.push_back(
            relative_row(fmt::format("{}: rise of the surface at {:g} us [K]", metal.name, times[k] * 1e6),
                         runs[r][k].rise, rise, spacings[r] < 7e-6 ? 0.03 : 0.05,
                         {resolution_text(spacings[r]), runs[r][k].seconds, "2 q / lambda sqrt(a t / pi)"}));
      }
      add_series(rows, spacings, series);
      // Both pass lines stand at 100 us; at 10 us the heat has gone through no more than two particles.
      for (std::size_t r = 0; r < spacings.size(); ++r)
        rows[rows.size() - spacings.size() + r].judged = times[k] > 5e-5 && spacings[r] < 1.5e-5;
    }
    for (std::size_t r = 0; r < spacings.size(); ++r)
      rows.push_back(limit_row(fmt::format("{}: heat stored = heat from the flux", metal.name),
                               runs[r].back().budget, 1e-3,
                               {resolution_text(spacings[r]), runs[r].back().seconds, "energy balance"}));
  }
  return rows;
}

}  // namespace meltray::app
