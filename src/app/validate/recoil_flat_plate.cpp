// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "app/validate/scenes.hpp"

namespace meltray::app {
namespace {

struct Pool {
  double interior = 0;  ///< mean pressure over that applied
  double force = 0;     ///< force on the floor over pressure times width
  double rms = 0;       ///< speed [m/s]
  double density = 0;   ///< largest variation
  double seconds = 0;
};

/// Pressure on the face of the floor, times width [N/m]: kernel average (cone of radius 2 h) of the pressure
/// of melt and of the first row of the floor, taken every half spacing and divided by its weights.
double floor_force(const Particles& p, const scene::Domain& domain) {
  const double dx = domain.spacing, radius = 2 * domain.smoothing_ratio * dx, floor = domain.min[1];
  const int points = static_cast<int>(std::lround((domain.max[0] - domain.min[0]) / (0.5 * dx)));
  std::vector<double> sum(static_cast<std::size_t>(points), 0.0), weight(sum);
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double depth = p.x[1][i] - floor, x = p.x[0][i];
    if (depth < -dx || depth > radius || x < domain.min[0] || x > domain.max[0]) continue;
    for (int k = 0; k < points; ++k) {
      const double w = 1 - std::hypot(x - domain.min[0] - 0.5 * dx * (k + 0.5), depth) / radius;
      if (w <= 0) continue;
      sum[static_cast<std::size_t>(k)] += w * p.pressure[i];
      weight[static_cast<std::size_t>(k)] += w;
    }
  }
  double force = 0;
  for (std::size_t k = 0; k < sum.size(); ++k) force += 0.5 * dx * sum[k] / weight[k];
  return force;
}

/// Mean pressure farther than 2 h below the flat surface and from the walls.
double interior_pressure(const Particles& p, const scene::Domain& domain) {
  const double away = 2 * domain.smoothing_ratio * domain.spacing;
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double x = p.x[0][i], z = p.x[1][i];
    if (!p.is_liquid(i) || p.has(i, kRemoved) || z > -away || z < domain.min[1] + away ||
        x < domain.min[0] + away || x > domain.max[0] - away)
      continue;
    sum += p.pressure[i];
    ++count;
  }
  return sum / count;
}

Pool run(const Setting& setting, scene::Overrides overrides, double pressure, double spacing, double end) {
  const Watch watch;
  overrides.insert(overrides.end(),
                   {fmt::format("surface.recoil_pressure_pa={}", pressure),
                    fmt::format("domain.spacing_m={}", spacing), fmt::format("time.end_s={}", end)});
  const auto simulation = start(setting, overrides);
  const scene::Domain& domain = simulation->scene().domain;
  const double ramp = simulation->scene().surface.recoil_ramp;
  const double width = domain.max[0] - domain.min[0];
  Pool pool;
  double weight = 0;
  advance(*simulation, end, [&, last = 0.0]() mutable {
    const double t = simulation->time(), dt = t - last;
    last = t;
    if (t <= ramp) return;
    const Particles& p = simulation->particles();
    pool.interior += dt * interior_pressure(p, domain) / pressure;
    pool.force += dt * floor_force(p, domain) / (pressure * width);
    const double speed = rms_speed(p);
    pool.rms += dt * speed * speed;
    weight += dt;
  });
  pool.interior /= weight;
  pool.force /= weight;
  pool.rms = std::sqrt(pool.rms / weight);
  pool.density = simulation->density_variation().largest;
  pool.seconds = watch.seconds();
  return pool;
}

}  // namespace

Rows recoil_flat_plate(const Setting& setting) {
  struct Entry {
    const char* name;
    scene::Overrides overrides;
    double pressure_tolerance, speed_share, speed_goal, speed;
  };
  // Weakly compressible with its own numerical viscosity, and with that of the other two.
  const scene::Overrides weak = {"flow.solver=wcsph", "flow.sound_speed_m_s=50"};
  scene::Overrides artificial = weak;
  artificial.insert(artificial.end(), {"terms.artificial_viscosity=true", "terms.interface_viscosity=false",
                                       "flow.shifting=0"});
  const std::vector<Entry> entries = {{"csf", {"surface.entry=csf"}, 0.03, 0.04, 0.01, 0.1},
                                      {"pressure", {"surface.entry=pressure"}, 0.01, 0.005, 0.005, 0.05},
                                      {"wcsph", artificial, 0.02, 0.04, 0.01, 0.1},
                                      {"wcsph, interface viscosity", weak, 0.02, 0.04, 0.01, 0.1}};
  // 54.7, 119.7 and 239.7 kPa: 0.54 p_sat of iron at its boiling point, 200 K and 400 K above it.
  const std::vector<double> pressures =
      setting.small ? std::vector<double>{54.7e3} : std::vector<double>{54.7e3, 119.7e3, 239.7e3};
  Rows rows;
  for (const Entry& e : entries)
    for (const double pressure : pressures) {
      std::optional<Pool> coarse;
      for (const double spacing : {1e-4, 5e-5}) {
        if (setting.small && spacing > 5e-5) continue;
        const Pool pool = run(setting, e.overrides, pressure, spacing, 1.6e-3);
        const Measured how{resolution_text(spacing), pool.seconds, "p = p_r everywhere, rest"};
        const std::string name = fmt::format("{}, {:.1f} kPa: ", e.name, pressure * 1e-3);
        const auto add = [&](Row row, double coarse_error, std::optional<double> goal = std::nullopt) {
          row.judged = spacing == 5e-5;
          row.goal = goal;
          if (coarse) row.order = observed_order(coarse_error, row.error, 2);
          rows.push_back(row);
        };
        const double scale = std::sqrt(2 * pressure / 7035.0);
        add(relative_row(name + "interior pressure / p_r", pool.interior, 1, e.pressure_tolerance, how),
            coarse ? std::abs(coarse->interior - 1) : 0);
        add(relative_row(name + "floor force / (p_r width)", pool.force, 1, e.pressure_tolerance, how),
            coarse ? std::abs(coarse->force - 1) : 0);
        add(limit_row(name + "rms speed / sqrt(2 p_r / rho)", pool.rms / scale, e.speed_share, how),
            coarse ? coarse->rms / scale : 0, e.speed_goal);
        add(limit_row(name + "rms speed [m/s]", pool.rms, e.speed, how), coarse ? coarse->rms : 0);
        if (pool.density > 0)
          add(limit_row(name + "density variation", pool.density, scene::DensityVariation::kAllowed, how), 0,
              0.01);
        coarse = pool;
      }
    }
  return rows;
}

}  // namespace meltray::app
