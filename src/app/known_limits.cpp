// SPDX-License-Identifier: MIT
#include "app/known_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace meltray::app {
namespace {

using scene::Scene;

// From the maps of stability: steps longer by this factor still left a weld's budgets and a pool or a drop in
// order.
constexpr double kWeldSteps = 4, kPoolSteps = 8;
// Strength of the interface viscosity up to which the projection in every stage allowed the steps of the
// flow.
constexpr double kStageViscosity = 50;

void step_factors(const Scene& s, std::vector<std::string>& found) {
  if (s.time.integrator.fixed_step > 0) return;
  const scene::Time usual;
  const double allowed = s.laser ? kWeldSteps : kPoolSteps;
  const std::array<std::pair<const char*, double>, 4> factors = {
      {{"cfl_advective", s.time.cfl_advective / usual.cfl_advective},
       {"cfl_capillary", s.time.cfl_capillary / usual.cfl_capillary},
       {"cfl_force", s.time.cfl_force / usual.cfl_force},
       {"laser_heating_k", s.time.laser_heating / usual.laser_heating}}};
  for (const auto& [name, factor] : factors)
    if (factor > allowed)
      found.push_back(
          fmt::format("time.{}: {:.3g} times the usual; single fast particles from more than {:g} times on",
                      name, factor, allowed));
}

}  // namespace

std::vector<std::string> beyond_known_limits(const Scene& s) {
  std::vector<std::string> found;
  step_factors(s, found);
  const double strength = std::max(s.flow.interface_viscosity_free, s.flow.interface_viscosity_solid);
  if (s.terms.interface_viscosity && s.flow.projection == scene::Projection::stage &&
      strength > kStageViscosity)
    found.push_back(
        fmt::format("flow.interface_viscosity_*: {:g} with the projection in every stage; beyond {:g} its "
                    "stiffness limits the step and may break the run down: splitting.projection = \"step\"",
                    strength, kStageViscosity));
  return found;
}

}  // namespace meltray::app
