// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/study/job.hpp"
#include "meltray/core/errors.hpp"

namespace meltray::app::studies {
scene::Scene Job::scene(const scene::Overrides& overrides) const {
  constexpr double kTight = 1e-3;
  scene::Scene s = scene::read_case(case_file, overrides);
  if (s.time.integrator.fixed_step > 0)
    for (double* tolerance : {&s.time.rtol, &s.time.atol_position, &s.time.atol_velocity,
                              &s.time.atol_temperature, &s.time.atol_density})
      *tolerance *= kTight;
  return s;
}

std::vector<double> halved_steps(double longest, int halvings) {
  std::vector<double> steps;
  for (int k = 0; k <= halvings; ++k) steps.push_back(std::ldexp(longest, -k));
  return steps;
}

Cell run_seeds(const Job& job, const scene::Overrides& overrides, std::vector<Quantities>* single) {
  if (job.definition.seeds.empty()) return job.run(overrides);
  constexpr std::int64_t Cell::*kCounts[] = {&Cell::steps, &Cell::rejected, &Cell::evaluations,
                                             &Cell::iterations, &Cell::pressure_iterations};
  std::vector<Quantities> runs;
  Cell sum;
  for (std::size_t k = 0; k < job.seeds(); ++k) {
    const Cell c = job.run(joined(overrides, {fmt::format("domain.seed={}", job.definition.seeds[k])}));
    if (!c.finished) return c;
    runs.push_back(c.quantities);
    for (auto count : kCounts) sum.*count += c.*count;
    sum.seconds += c.seconds;
    sum.cpu_seconds += c.cpu_seconds;
  }
  const auto n = static_cast<double>(job.seeds());
  for (auto count : kCounts) sum.*count = std::llround(static_cast<double>(sum.*count) / n);
  sum.seconds /= n;
  sum.cpu_seconds /= n;
  sum.finished = true;
  sum.quantities = mean(runs);
  if (single != nullptr) *single = runs;
  return sum;
}

Reference reference(const Job& job, const std::string& model, const scene::Overrides& base, double step,
                    Findings& findings) {
  const scene::Scene scene = job.scene(base);
  const Variant v = reference_variant(scene, model);
  std::vector<Quantities> single;
  const auto run = [&](double dt, std::vector<Quantities>* runs) {
    const Cell cell = run_seeds(job, joined(base, joined(v.overrides, fixed_step(dt))), runs);
    if (!cell.finished)
      throw NumericalFailure(
          fmt::format("reference '{}' with steps of {:.3g} s: {}", v.name, dt, cell.failure));
    return cell.quantities;
  };
  Reference out;
  out.quantities = run(step, &single);
  const Quantities second = run(2 * step, nullptr);
  for (std::size_t q = 0; q < out.quantities.size(); ++q) {
    out.uncertainty.push_back(relative_error(second[q], out.quantities[q]));
    double variance = 0;
    for (const Quantities& one : single)
      variance +=
          std::pow(relative_error(one[q], out.quantities[q]), 2) / static_cast<double>(single.size() - 1);
    out.spread.push_back(std::sqrt(variance));
    findings.references.push_back({{"spacing_m", scene.domain.spacing},
                                   {"model", model},
                                   {"method", v.name},
                                   {"step_s", step},
                                   {"quantity", out.quantities[q].name},
                                   {"uncertainty", out.uncertainty.back()},
                                   {"spread_over_seeds", out.spread.back()}});
  }
  return out;
}

}  // namespace meltray::app::studies
