// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/validate/scenes.hpp"
#include "meltray/core/constants.hpp"
#include "meltray/core/errors.hpp"

namespace meltray::app {
namespace {

/// u = -U F cos(k x) sin(k z), w = U F sin(k x) cos(k z), F = exp(-8 pi^2 t / Re), k = 2 pi;
/// p = -(rho U^2 / 4) F^2 (cos 2kx + cos 2kz) (Taylor & Green 1937). U = L = rho = 1.
constexpr double kReynolds = 100;
constexpr double kDecay = 8 * constants::pi * constants::pi / kReynolds;

double factor(double t) {
  return std::exp(-kDecay * t);
}

/// Of one particle; `amplitude` is F^2.
double exact_pressure(const Particles& p, std::size_t i, double amplitude) {
  const double k = 4 * constants::pi;
  return -0.25 * amplitude * (std::cos(k * p.x[0][i]) + std::cos(k * p.x[1][i]));
}

struct Result {
  double velocity = 0;     ///< relative L2 error at the end
  double velocity_l1 = 0;  ///< sum |v - exact| / sum |exact| at the end
  double speed_l1 = 0;     ///< |mean |v| - mean |exact|| / mean |exact| at the end
  double pressure = 0;     ///< relative L2 error, mean over the second half of the run
  double decay = 0;     ///< between a quarter of the run, when the jitter has relaxed, and the end [1/time]
  double clumping = 0;  ///< 1 - smallest distance of two particles / spacing, at the end
  double seconds = 0, spacing = 0;
};

double pressure_error(const Particles& p, double amplitude) {
  const auto n = static_cast<double>(p.size());
  double mean = 0, error = 0, scale = 0;
  for (std::size_t i = 0; i < p.size(); ++i) mean += p.pressure[i] / n;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double exact = exact_pressure(p, i, amplitude);
    error += std::pow(p.pressure[i] - mean - exact, 2);
    scale += exact * exact;
  }
  return std::sqrt(error / scale);
}

void compare_velocities(const Particles& p, double amplitude, Result& result) {
  const double k = 2 * constants::pi;
  double l2 = 0, scale2 = 0, l1 = 0, scale1 = 0, speed = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double x = k * p.x[0][i], z = k * p.x[1][i];
    const double u = -amplitude * std::cos(x) * std::sin(z), w = amplitude * std::sin(x) * std::cos(z);
    const double error = std::hypot(p.v[0][i] - u, p.v[1][i] - w), exact = std::hypot(u, w);
    l2 += error * error;
    scale2 += exact * exact;
    l1 += error;
    scale1 += exact;
    speed += std::hypot(p.v[0][i], p.v[1][i]);
  }
  result.velocity = std::sqrt(l2 / scale2);
  result.velocity_l1 = l1 / scale1;
  result.speed_l1 = std::abs(speed / scale1 - 1);
}

double clumping(const Particles& p, double spacing) {
  double least = 1e300;
  const auto apart = [](double d) { return d - std::round(d); };  // in the periodic unit box
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      least = std::min(least, std::hypot(apart(p.x[0][i] - p.x[0][j]), apart(p.x[1][i] - p.x[1][j])));
  return 1 - least / spacing;
}

/// A way to run the vortices.
struct Variant {
  std::string name;
  scene::Overrides overrides = {};
  std::vector<double> spacings;
  std::string step_key = {};   ///< of a length of steps that goes with the spacing
  double step = 0;             ///< its value over dx / U
  double interface_ratio = 0;  ///< h / dx with interface viscosity everywhere instead of the physical one
  double decay_line = 0.03;
  bool judged = true;
  bool noisy = false;  ///< the pressure is known to miss its line: the twin does not judge it
};

/// Interface viscosity everywhere, as if at the solid: nu = alpha h c / 8 in two dimensions (Monaghan 2005,
/// sect. 4.1). A ramp of 1e7 K leaves no melt that is too hot for it.
scene::Overrides interface_viscosity(double ratio, double spacing, double nu) {
  constexpr double kSpeed = 10;
  return {"terms.viscosity=false",
          "terms.interface_viscosity=true",
          "flow.interface_viscosity_ramp_k=1e7",
          fmt::format("domain.smoothing_ratio={}", ratio),
          fmt::format("flow.reference_speed_m_s={}", kSpeed),
          fmt::format("flow.interface_viscosity_solid={}", 8 * nu / (ratio * spacing * kSpeed))};
}

/// WCSPH starts with the density of the exact pressure: with one density everywhere it would ring.
void set_density(scene::Simulation& simulation) {
  const double c = simulation.scene().flow.sound_speed;
  Particles& p = simulation.particles();
  if (p.density.empty()) return;
  for (std::size_t i = 0; i < p.size(); ++i) {
    p.density[i] = 1 + exact_pressure(p, i, 1) / (c * c);
    p.mass[i] *= p.density[i];
  }
}

Result run(const Setting& setting, const Variant& variant, double spacing, double end) {
  const Watch watch;
  scene::Overrides overrides = variant.overrides;
  overrides.push_back(fmt::format("domain.spacing_m={}", spacing));
  if (variant.step > 0) overrides.push_back(fmt::format("{}={}", variant.step_key, variant.step * spacing));
  if (variant.interface_ratio > 0)
    for (const std::string& key : interface_viscosity(variant.interface_ratio, spacing, 1 / kReynolds))
      overrides.push_back(key);
  const auto simulation = start(setting, overrides);
  set_density(*simulation);
  const Particles& p = simulation->particles();
  Result result;
  double weight = 0, quarter_speed = 0, quarter_time = 0;
  advance(*simulation, end, [&, last = 0.0]() mutable {
    const double t = simulation->time(), dt = t - last;
    last = t;
    if (t <= 0.25 * end) {
      quarter_speed = rms_speed(p);
      quarter_time = t;
    }
    if (t < 0.5 * end) return;
    result.pressure += dt * pressure_error(p, std::pow(factor(t), 2));
    weight += dt;
  });
  result.pressure /= weight;
  compare_velocities(p, factor(end), result);
  result.decay = std::log(quarter_speed / rms_speed(p)) / (end - quarter_time);
  result.clumping = clumping(p, spacing);
  result.seconds = watch.seconds();
  result.spacing = spacing;
  return result;
}

std::vector<Variant> variants(bool small) {
  const std::vector<double> two = {1.0 / 25, 1.0 / 50}, three = {1.0 / 25, 1.0 / 50, 1.0 / 100};
  const scene::Overrides wcsph = {"flow.solver=wcsph", "flow.sound_speed_m_s=10", "flow.tension=full"};
  scene::Overrides multirate = wcsph;
  for (const char* key : {"terms.conduction=true", "material.conductivity_solid_w_m_k=1e-3",
                          "material.conductivity_liquid_w_m_k=1e-3", "material.latent_heat_fusion_j_kg=0",
                          "time.method=multirate"})
    multirate.emplace_back(key);
  const char* const step = "time.max_step_s";
  std::vector<Variant> all = {
      {.name = "stage", .overrides = {"splitting.projection=stage"}, .spacings = three},
      {.name = "step", .spacings = three, .step_key = step, .step = 0.1},
      {.name = "interface viscosity, h/dx 1.8",
       .spacings = two,
       .step_key = step,
       .step = 0.1,
       .interface_ratio = 1.8,
       .decay_line = 0.05},
      {.name = "interface viscosity, h/dx 1.3",
       .spacings = two,
       .step_key = step,
       .step = 0.1,
       .interface_ratio = 1.3,
       .judged = false},
      {.name = "wcsph", .overrides = wcsph, .spacings = two, .noisy = true},
      // Slow steps of 2.2 h / c, as in the iron welds.
      {.name = "wcsph, multirate",
       .overrides = multirate,
       .spacings = two,
       .step_key = "time.fixed_step_s",
       .step = 0.4,
       .noisy = true}};
  if (small)
    for (Variant& v : all) v.spacings = {1.0 / 30};
  return all;
}

}  // namespace

Rows taylor_green(const Setting& setting) {
  const double end = setting.small ? 0.2 : 2.0;
  Rows rows;
  for (const Variant& v : variants(setting.small)) {
    std::optional<Result> coarse;
    for (const double spacing : v.spacings) {
      Measured how{resolution_text(spacing), 0, "Taylor & Green 1937"};
      Result r;
      try {
        r = run(setting, v, spacing, end);
      } catch (const NumericalFailure& e) {
        how.source = e.what();
        rows.push_back(limit_row(fmt::format("{}: runs to t = {}", v.name, end), std::nan(""), 0, how));
        continue;
      }
      how.seconds = r.seconds;
      const bool judged = v.judged && (setting.small || spacing == 1.0 / 50);
      const auto add = [&](Row row, double coarse_error, std::optional<double> goal) {
        row.judged = judged;
        row.goal = goal;
        if (coarse) row.order = observed_order(coarse_error, row.error, coarse->spacing / spacing);
        rows.push_back(row);
      };
      const std::string name = v.name + ": ";
      add(relative_row(name + "decay rate", r.decay, kDecay, v.decay_line, how),
          coarse ? std::abs(coarse->decay / kDecay - 1) : 0, std::nullopt);
      add(limit_row(name + "velocity, L2", r.velocity, 0.05, how), coarse ? coarse->velocity : 0,
          std::nullopt);
      add(limit_row(name + "velocity, L1", r.velocity_l1, 0.05, how), coarse ? coarse->velocity_l1 : 0, 0.01);
      add(limit_row(name + "speed, L1 of means", r.speed_l1, 0.05, how), coarse ? coarse->speed_l1 : 0,
          std::nullopt);
      add(limit_row(name + "pressure, L2", r.pressure, 0.10, how), coarse ? coarse->pressure : 0, 0.02);
      if (v.noisy && setting.small) rows.back().judged = false;
      Row clumps = limit_row(name + "clumping, 1 - least distance / dx", r.clumping, 1, how);
      clumps.judged = false;
      rows.push_back(clumps);
      coarse = r;
    }
  }
  return rows;
}

}  // namespace meltray::app
