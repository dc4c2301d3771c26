// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "app/study/job.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/core/nearest.hpp"

namespace meltray::app::studies {
namespace {

/// Bounds of a cell that counts as stable.
constexpr double kEnergyBound = 1e-6, kMomentumBound = 1e-6;
constexpr double kAtLimitBound = 0.01;  ///< share of pressure solves that end at their limit of iterations
constexpr double kClampedBound = 1e-3;  ///< share of the steps of all liquid particles
constexpr double kSpeedBound = 3;       ///< times the largest speed that is expected
constexpr double kUndershoot = 5;       ///< below the lowest temperature of the case as it is [K]
constexpr std::int64_t kMostSteps = 50000;

/// How a speed grows with what drives it: with the root of a pressure; with a force while the melt still
/// gathers speed, as in the short scene of natural convection; with the power at most, whose recoil sets in
/// at the boiling point.
constexpr double kByPressure = 0.5, kFromRest = 1, kByPower = 1, kNoDrive = 0;

/// A number of the scene that the map varies.
struct Parameter {
  std::string name;
  std::vector<double> factors;
  double exponent;  ///< of the factor in the speed that is expected, 0 where it does not drive the flow
  bool (*applies)(const scene::Scene&);
  void (*scale)(scene::Scene&, double factor);

  /// Speed that is expected at a factor, over that of the case as it is. Less drive does not make it smaller:
  /// something else may drive the flow, too.
  double speed(double factor) const { return std::pow(std::max(1.0, factor), exponent); }
};

void scale(Property& p, double factor) {
  if (p.form == Property::Form::andrade) {
    p.a += std::log10(factor);
    return;
  }
  p.a *= factor;
  p.b *= factor;
}

const std::vector<Parameter>& parameters() {
  using scene::Scene;
  static const std::vector<Parameter> all = {{"power",
                                              {0.25, 0.5, 1, 2, 4},
                                              kByPower,
                                              [](const Scene& s) { return s.laser.has_value(); },
                                              [](Scene& s, double f) {
                                                s.laser->beam.power *= f;
                                                s.laser->beam.amplitude *= f;
                                                for (auto& [time, power] : s.laser->beam.table) power *= f;
                                              }},
                                             {"surface_tension",
                                              {0.1, 0.3, 1, 3, 10},
                                              kByPressure,
                                              [](const Scene& s) { return s.terms.surface_tension; },
                                              [](Scene& s, double f) {
                                                scale(s.material.surface_tension, f);
                                                s.material.surface_tension_floor *= f;
                                              }},
                                             {"recoil",
                                              {0.25, 0.5, 1, 2, 4},
                                              kByPressure,
                                              [](const Scene& s) { return s.terms.recoil; },
                                              [](Scene& s, double f) {
                                                s.surface.recoil_pressure *= f;
                                                s.surface.recoil_coefficient *= f;
                                              }},
                                             {"viscosity_ratio",
                                              {0.01, 0.1, 1, 10, 100},
                                              kNoDrive,
                                              [](const Scene& s) { return s.terms.interface_viscosity; },
                                              [](Scene& s, double f) {
                                                s.flow.interface_viscosity_free *= f;
                                                s.flow.interface_viscosity_solid *= f;
                                              }},
                                             {"buoyancy",
                                              {0.1, 1, 10, 100},
                                              kFromRest,
                                              [](const Scene& s) { return s.terms.buoyancy; },
                                              [](Scene& s, double f) { s.domain.gravity *= f; }},
                                             {"jitter",
                                              {0.01, 0.1, 0.2, 0.3, 0.4},
                                              kNoDrive,
                                              [](const Scene&) { return true; },
                                              [](Scene& s, double f) {
                                                s.domain.arrangement = scene::Arrangement::jittered;
                                                s.domain.jitter = f;
                                              }},
                                             {"seed",
                                              {1, 2, 3, 4, 5},
                                              kNoDrive,
                                              [](const Scene&) { return true; },
                                              [](Scene& s, double f) {
                                                if (s.domain.arrangement != scene::Arrangement::jittered)
                                                  s.domain.jitter = 0.1;
                                                s.domain.arrangement = scene::Arrangement::jittered;
                                                s.domain.seed = static_cast<int>(f);
                                              }}};
  return all;
}

const Parameter& find(const std::string& name, const scene::Scene& scene) {
  const auto known = stability_parameters(scene);
  const std::string wanted = name.empty() ? known.front() : name;
  for (const Parameter& p : parameters())
    if (p.name == wanted && p.applies(scene)) return p;
  throw UsageError(fmt::format("study stability: found parameter '{}'; allowed {}; did you mean '{}'?", name,
                               fmt::join(known, ", "), nearest_name(name, known)));
}

/// Every limit of the step times `factor`; the constant step where there is one.
void scale_steps(scene::Time& time, double factor) {
  for (double* share :
       {&time.cfl_advective, &time.cfl_capillary, &time.cfl_force, &time.cfl_viscous, &time.cfl_thermal,
        &time.cfl_acoustic, &time.beam_travel, &time.laser_heating, &time.integrator.fixed_step})
    *share *= factor;
  if (time.integrator.max_step < 1e300) time.integrator.max_step *= factor;
}

struct Verdict {
  std::string word, reason;
};

/// `usual`: the case as it is; `speed`: what is expected over its speed.
Verdict judge(const Cell& cell, const Cell& usual, double speed) {
  if (!cell.finished) return {"failed", failed_term(cell.failure)};
  if (!(cell.energy_error <= kEnergyBound))
    return {"degraded", fmt::format("energy budget {:.1e}", cell.energy_error)};
  if (!(cell.momentum_error <= kMomentumBound))
    return {"degraded", fmt::format("momentum budget {:.1e}", cell.momentum_error)};
  if (static_cast<double>(cell.pressure_at_limit) > kAtLimitBound * static_cast<double>(cell.pressure_solves))
    return {"degraded", fmt::format("{} of {} pressure solves at their limit", cell.pressure_at_limit,
                                    cell.pressure_solves)};
  const double clamped = static_cast<double>(cell.clamped) /
                         static_cast<double>(std::max<std::int64_t>(1, cell.liquid_particle_steps));
  if (clamped > kClampedBound)
    return {"degraded", fmt::format("{} particles clamped or removed, {:.2g} % of all steps of particles",
                                    cell.clamped, 100 * clamped)};
  if (usual.finished && cell.top_speed > kSpeedBound * speed * usual.top_speed)
    return {"degraded", fmt::format("speed {:.3g} m/s", cell.top_speed)};
  if (usual.finished && cell.lowest_temperature < usual.lowest_temperature - kUndershoot)
    return {"degraded", fmt::format("temperature {:.0f} K", cell.lowest_temperature)};
  return {"stable", ""};
}

}  // namespace

std::vector<std::string> stability_parameters(const scene::Scene& scene) {
  std::vector<std::string> names;
  for (const Parameter& p : parameters())
    if (p.applies(scene)) names.push_back(p.name);
  return names;
}

Findings stability(const Job& job, const std::string& name) {
  const scene::Scene base = job.scene();
  const Parameter& parameter = find(name, base);
  std::vector<double> refinements = {1, 0.75}, step_factors = {0.5, 1, 2, 4, 8, 16, 32},
                      factors = parameter.factors;
  if (job.small) {
    refinements = {1};
    step_factors = {1, 8};
    factors = {factors.front(), factors.back()};
  }
  Findings out;
  int count[3] = {0, 0, 0};
  for (double refinement : refinements) {
    const auto cell_of = [&](double factor, double step_factor, bool as_it_is) {
      scene::Scene scene = job.scene({fmt::format("domain.spacing_m={}", refinement * base.domain.spacing)});
      scale_steps(scene.time, step_factor);
      if (!as_it_is) parameter.scale(scene, factor);
      return job.cells.run(scene, no_quantities, job.definition.id, kMostSteps);
    };
    const Cell usual = cell_of(1, 1, true);
    for (double factor : factors)
      for (double step_factor : step_factors) {
        const Cell cell = cell_of(factor, step_factor, false);
        const Verdict verdict = judge(cell, usual, parameter.speed(factor));
        ++count[verdict.word == "stable" ? 0 : verdict.word == "degraded" ? 1 : 2];
        if (verdict.word != "stable")
          out.conclusions.push_back(fmt::format("{} {:.3g}, dx {:.3g} m, steps x{}: {}: {}", parameter.name,
                                                factor, refinement * base.domain.spacing, step_factor,
                                                verdict.word, verdict.reason));
        out.rows.push_back({{"parameter", parameter.name},
                            {"factor", factor},
                            {"spacing_m", refinement * base.domain.spacing},
                            {"step_factor", step_factor},
                            {"verdict", verdict.word},
                            {"reason", verdict.reason},
                            {"reached_s", cell.reached},
                            {"steps", cell.steps},
                            {"top_speed_m_s", cell.top_speed},
                            {"energy_error", cell.energy_error},
                            {"momentum_error", cell.momentum_error},
                            {"pressure_at_limit", cell.pressure_at_limit},
                            {"clamped", cell.clamped},
                            {"cpu_seconds", cell.cpu_seconds}});
      }
  }
  out.conclusions.push_back(fmt::format("{} stable, {} degraded, {} failed", count[0], count[1], count[2]));
  return out;
}

}  // namespace meltray::app::studies
