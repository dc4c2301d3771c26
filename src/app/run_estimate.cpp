// SPDX-License-Identifier: MIT
#include "app/run_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "meltray/core/parallel.hpp"
#include "meltray/scene/elastic.hpp"

namespace meltray::app {
namespace {

using scene::Scene;
using scene::Simulation;

/// Liquid particles of a developed pool: its width and length in focal diameters, its depth per power.
constexpr double kPoolWidth = 2, kPoolLength = 4, kDepthPerPower = 1e-6;  // the last in [m/W]
/// Core time of one step: per liquid particle (of a weld: with the solid and the surface that go with it),
/// and per step of a scene with a laser whatever its melt. Rough figures of the iron welds on two cores,
/// where the mean step was half the shortest limit, since spatter and error control shorten it.
constexpr double kSecondsPerParticleStep = 4e-6, kSecondsPerWeldParticleStep = 1.4e-5;
/// The same of a weakly compressible scene without a laser: two passes over the octets.
constexpr double kSecondsPerSoundParticleStep = 1.5e-6;
/// Of one fast step of three stages, and how many of them a slow step of the cases has.
constexpr double kSecondsPerFastParticleStep = 2.3e-6, kUsualFastSteps = 3;
/// A weld in elastic solid over one in fixed solid: its solid near the melt is two to three times as much.
constexpr double kElasticWeld = 3;
constexpr double kSecondsPerLaserStep = 1.5e-2, kShareOfLimit = 0.5;

/// Liquid particles to expect: those at the start, or a pool of a stated size where a laser melts solid.
double expected_liquid(const Simulation& simulation) {
  const Scene& s = simulation.scene();
  const double now = static_cast<double>(simulation.liquid_count());
  if (now > 0 || !s.laser || !s.terms.melting) return now;
  const double spot = s.laser->beam.focal_diameter;
  const double volume = kPoolWidth * spot * kPoolLength * spot * kDepthPerPower * s.laser->beam.power;
  std::size_t material = 0;
  for (std::size_t i = 0; i < simulation.particles().size(); ++i)
    material += !simulation.particles().is_wall(i);
  return std::min(volume / std::pow(s.domain.spacing, 3), 0.5 * static_cast<double>(material));
}

}  // namespace

void print_run_time(const Simulation& simulation, double step) {
  heading("run time (a rough estimate)");
  const Scene& s = simulation.scene();
  const double fixed = s.time.integrator.fixed_step,
               flow = s.flow.solver == scene::FlowSolver::wcsph ? kSecondsPerSoundParticleStep
                                                                : kSecondsPerParticleStep,
               cost = s.laser ? kSecondsPerWeldParticleStep : flow;
  double dt = step > 0 ? std::min(step, s.time.integrator.max_step) : s.time.integrator.max_step;
  if (s.laser) dt *= kShareOfLimit;
  if (fixed > 0) dt = fixed;
  double count = expected_liquid(simulation);
  if (count == 0) count = static_cast<double>(simulation.active_count());
  if (!(dt > 0 && dt < s.time.end)) {
    line("unknown", "no limit sets the step before the run: error control does");
    return;
  }
  const double steps = s.time.end / dt;
  double core = steps * (count * cost + (s.laser ? kSecondsPerLaserStep : 0.0));
  // A slow step of a weld has some three fast ones; what is more of them comes on top.
  if (s.time.integrator.method == Method::multirate && step > 0 && dt / step > kUsualFastSteps)
    core += (s.time.end / step - kUsualFastSteps * steps) * count * kSecondsPerFastParticleStep;
  if (s.laser && scene::is_elastic(s)) core *= kElasticWeld;
  const double seconds = core / threads();
  line("steps", fmt::format("{:.3g} of {:.3g} s", steps, dt));
  line("particles that cost", fmt::format("{:.3g}", count));
  line("stated cost of a step",
       fmt::format("{:g} core-us per particle{}; not measured on this machine", 1e6 * cost,
                   s.laser ? fmt::format(" + {:g} core-ms", 1e3 * kSecondsPerLaserStep) : ""));
  line("estimate", fmt::format("about {:.2g} {} on {} thread{}; good to an order of magnitude",
                               seconds < 120 ? seconds : seconds / 60, seconds < 120 ? "s" : "min", threads(),
                               threads() == 1 ? "" : "s"));
}

}  // namespace meltray::app
