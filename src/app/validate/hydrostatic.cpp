// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "app/validate/scenes.hpp"

namespace meltray::app {
namespace {

/// The tank at one time.
struct Moment {
  double pressure = 0;  ///< L2 error of the interior pressure, relative to its own L2 norm
  double speed = 0;     ///< largest over sqrt(g H)
  double bias = 0;      ///< mean of p - rho g (H - z) in the layer below the surface over rho g H
  double density = 0;   ///< largest relative deviation of the density
};

/// Over the last quarter of a run: root mean square of the pressure error, mean bias, largest of the others.
struct Tank : Moment {
  double seconds = 0;
};
constexpr double kFrom = 0.75;

/// The state of rest: pressure rho g (H - z) in every particle, with the density that goes with it and the
/// mass that gives it its place on the lattice; equal masses would leave the bottom thinner than its density
/// says.
void set_rest(scene::Simulation& simulation) {
  const double c = simulation.scene().flow.sound_speed;
  Particles& p = simulation.particles();
  if (p.density.empty()) return;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (p.is_liquid(i)) {
      p.density[i] = 1 + (1 - p.x[1][i]) / (c * c);
      p.mass[i] *= p.density[i];
    }
}

Moment look(const scene::Simulation& simulation) {
  const scene::Domain& domain = simulation.scene().domain;
  const Particles& p = simulation.particles();
  const double h = domain.smoothing_ratio * domain.spacing, away = 3 * h;
  Moment now;
  double error = 0, size = 0, layer = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.is_liquid(i)) continue;
    const double x = p.x[0][i], z = p.x[1][i], exact = 1 - z;
    now.speed = std::max(now.speed, std::hypot(p.v[0][i], p.v[1][i]));
    if (!p.density.empty()) now.density = std::max(now.density, std::abs(p.density[i] - 1));
    if (x < away || x > 1 - away || z < away) continue;
    if (z > 1 - 2 * h) {
      now.bias += p.pressure[i] - exact;
      ++layer;
    }
    if (z > 1 - away) continue;
    error += (p.pressure[i] - exact) * (p.pressure[i] - exact);
    size += exact * exact;
  }
  now.pressure = std::sqrt(error / size);
  now.bias /= layer;
  return now;
}

Tank run(const Setting& setting, const scene::Overrides& overrides, double spacing, double end) {
  const Watch watch;
  scene::Overrides all = overrides;
  all.push_back(fmt::format("domain.spacing_m={}", spacing));
  const auto simulation = start(setting, all);
  set_rest(*simulation);
  Tank tank;
  double weight = 0;
  advance(*simulation, end, [&, last = 0.0]() mutable {
    const double t = simulation->time(), dt = t - last;
    last = t;
    if (t < kFrom * end) return;
    const Moment m = look(*simulation);
    tank.pressure += dt * m.pressure * m.pressure;
    tank.bias += dt * m.bias;
    tank.speed = std::max(tank.speed, m.speed);
    tank.density = std::max(tank.density, m.density);
    weight += dt;
  });
  tank.pressure = std::sqrt(tank.pressure / weight);
  tank.bias /= weight;
  tank.seconds = watch.seconds();
  return tank;
}

}  // namespace

Rows hydrostatic(const Setting& setting) {
  struct Variant {
    const char* name;
    scene::Overrides overrides;
    bool judged;
  };
  // The plain diffusion is known to disturb the pressure of a tank at rest: it is there for comparison.
  // With the shifting of the row of Table 1: without it the layers move against each other in the end.
  const scene::Overrides isph = {"flow.solver=isph", "terms.artificial_viscosity=false",
                                 "flow.pressure_tolerance=1e-6", "flow.shifting=4",
                                 "flow.shifting_speed_m_s=0.1"};
  // The speed that is left in the corners falls with the step.
  scene::Overrides short_steps = isph;
  short_steps.emplace_back("time.max_step_s=1e-3");
  const std::vector<Variant> models = {
      {"wcsph, antuono", {}, true},
      {"wcsph, molteni_colagrossi", {"flow.density_diffusion=molteni_colagrossi"}, false},
      {"isph", isph, !setting.small},
      {"isph, steps of 1e-3", short_steps, !setting.small}};
  const double end = setting.small ? 1.0 : 2.0;
  const std::vector<double> spacings =
      setting.small ? std::vector<double>{0.02} : std::vector<double>{0.04, 0.02};
  Rows rows;
  for (const Variant& m : models) {
    if (setting.small && !m.judged) continue;
    std::optional<Tank> coarse;
    for (const double spacing : spacings) {
      const Tank tank = run(setting, m.overrides, spacing, end);
      const Measured how{resolution_text(spacing), tank.seconds, "p = rho g (H - z)"};
      const std::string name = std::string(m.name) + ": ";
      const auto add = [&](Row row, double coarse_error) {
        row.judged = m.judged && spacing == spacings.back();
        if (coarse) row.order = observed_order(coarse_error, row.error, 2);
        rows.push_back(row);
      };
      add(limit_row(name + "interior pressure L2", tank.pressure, 0.01, how), coarse ? coarse->pressure : 0);
      add(limit_row(name + "largest speed / sqrt(g H)", tank.speed, 1e-3, how), coarse ? coarse->speed : 0);
      add(limit_row(name + "pressure bias below the surface", tank.bias, 0.01, how),
          coarse ? std::abs(coarse->bias) : 0);
      if (tank.density > 0) add(limit_row(name + "largest density variation", tank.density, 0.011, how), 0);
      coarse = tank;
    }
  }
  return rows;
}

}  // namespace meltray::app
