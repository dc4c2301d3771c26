// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "app/validate/neumann.hpp"
#include "app/validate/scenes.hpp"

namespace meltray::app {
namespace {

constexpr double kMelting = 1811;

Neumann exact_solution(const scene::Scene& scene, double initial) {
  const Material& m = scene.material;
  return {m.density,
          m.latent_heat_fusion,
          m.conductivity_liquid(kMelting),
          m.heat_capacity_liquid,
          m.conductivity_solid(kMelting),
          m.heat_capacity_solid,
          scene.domain.faces[0].temperature,
          kMelting,
          initial};
}

struct Result {
  double front = 0;              ///< [m]
  double liquid = 0, solid = 0;  ///< relative L2 errors of temperature
  double budget = 0;             ///< of energy, relative
  double seconds = 0, spacing = 0;
  std::int64_t steps = 0;
  double exact_front = 0;
};

/// Errors over liquid and solid: |T - T_exact| over |T_exact - T_m| and |T_exact - T_0|. Where the solid
/// starts at the melting point its temperature does not change and there is nothing to compare.
void measure_profile(const scene::Simulation& simulation, const Neumann& exact, Result& result) {
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

Result run(const Setting& setting, double spacing, double initial, double end, double tolerance) {
  const Watch watch;
  // Twelve particles across: a periodic direction has to be three supports long.
  const double height = 12 * spacing;
  const auto simulation = start(
      setting,
      {fmt::format("domain.spacing_m={}", spacing), fmt::format("domain.max_m=[2e-3,{}]", height),
       fmt::format("bodies.0.max_m=[2e-3,{}]", height), fmt::format("bodies.0.temperature_k={}", initial),
       fmt::format("time.end_s={}", end), fmt::format("time.atol_temperature_k={}", tolerance)});
  advance(*simulation, end);
  // The front is where the melt would end if all that is molten, in parts too, were gathered at the wall.
  const scene::Scene& scene = simulation->scene();
  const Particles& p = simulation->particles();
  Result result;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (!p.is_wall(i))
      result.front += scene.material.liquid_fraction(p.h[i]) * p.mass[i] / (scene.material.density * height);
  const Neumann exact = exact_solution(scene, std::min(initial, kMelting));
  result.exact_front = exact.front(end);
  measure_profile(*simulation, exact, result);
  result.budget = simulation->energy().relative_error();
  result.steps = simulation->counters().steps;
  result.seconds = watch.seconds();
  result.spacing = spacing;
  return result;
}

void add_rows(const std::string& name, const Result& r, const Result* coarse, bool judged, bool has_solid,
              Rows& rows) {
  const Measured how{resolution_text(r.spacing), r.seconds, "Neumann's two-phase similarity solution"};
  const double ratio = coarse ? coarse->spacing / r.spacing : 0;
  const auto add = [&](Row row, double coarse_error) {
    row.judged = judged;
    if (coarse) row.order = observed_order(coarse_error, row.error, ratio);
    rows.push_back(row);
  };
  const auto front_error = [](const Result& x) { return std::abs(x.front / x.exact_front - 1); };
  add(relative_row(name + ": front [m]", r.front, r.exact_front, 0.02, how),
      coarse ? front_error(*coarse) : 0);
  add(limit_row(name + ": profile in the liquid, L2", r.liquid, 0.015, how), coarse ? coarse->liquid : 0);
  if (has_solid)
    add(limit_row(name + ": profile in the solid, L2", r.solid, 0.015, how), coarse ? coarse->solid : 0);
  Row budget = limit_row(name + ": heat stored = heat from the wall", r.budget, 1e-3, how);
  budget.goal = 1e-6;
  rows.push_back(budget);
}

}  // namespace

Rows stefan_two_phase_iron(const Setting& setting) {
  // The small twin ends at 2.5 ms with 20 um: the front has then passed as many particles as with 40 um at
  // 10 ms, and only the pass line of the front can be asked for.
  const double end = setting.small ? 2.5e-3 : 10e-3;
  const std::vector<double> spacings =
      setting.small ? std::vector<double>{4e-5, 2e-5} : std::vector<double>{4e-5, 2e-5, 1e-5};
  Rows rows;
  for (const bool cold : {true, false}) {
    const std::string name = cold ? "T_0 = 1300 K" : "T_0 = T_m";
    // At the lower end of the melting band: solid, and within 0.1 K of the melting point.
    const double initial = cold ? 1300 : 1810.9;
    std::optional<Result> coarse;
    for (const double spacing : spacings) {
      const Result r = run(setting, spacing, initial, end, 5);
      add_rows(name, r, coarse ? &*coarse : nullptr, spacing == spacings.back(), cold, rows);
      coarse = r;
    }
    if (!cold || setting.small) continue;
    // Latent heat cannot be stepped over: a step control ten times tighter gives the same front.
    const Result fine = run(setting, spacings.back(), initial, end, 0.5);
    rows.push_back(relative_row(
        fmt::format("{}: front, {} against {} steps [m]", name, coarse->steps, fine.steps), coarse->front,
        fine.front, 0.01,
        {resolution_text(fine.spacing), fine.seconds, "the same with a tenth of the error per step"}));
  }
  return rows;
}

}  // namespace meltray::app
