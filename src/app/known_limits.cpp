// SPDX-License-Identifier: MIT
#include "app/known_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "meltray/scene/body_bounds.hpp"
#include "meltray/scene/closed_box.hpp"
#include "meltray/scene/elastic.hpp"

namespace meltray::app {
namespace {

using scene::Body, scene::Domain, scene::Scene, scene::ShapeKind;

// From the maps of stability: steps longer by this factor still left a weld's budgets and a pool or a drop in
// order, and water that collapses inside its walls.
constexpr double kWeldSteps = 4, kPoolSteps = 8, kCollapseSteps = 2;
// Strength of the interface viscosity up to which the projection in every stage allowed the steps of the
// flow.
constexpr double kStageViscosity = 50;
// Modulus of elastic solid, over the metal's own, with which welds of both metals held for a millisecond.
constexpr double kWeldModulus = 0.01;
// Strength of the interface viscosity below which vapour at the temperature of the particles throws melt out,
// and above which vapour at that of the faces cannot push it away.
constexpr double kFrontViscosity = 0.3;

void step_factors(const Scene& s, std::vector<std::string>& found) {
  if (s.time.integrator.fixed_step > 0) return;
  const scene::Time usual;
  const double allowed = s.laser ? kWeldSteps : s.terms.surface_tension ? kPoolSteps : kCollapseSteps;
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

/// A box of walls that one body fills: there is no gas in it.
bool closed_and_full(const Domain& domain) {
  const auto fills = [&](const Body& body) {
    bool all = body.shape == ShapeKind::box;
    for (int c = 0; c < domain.dimension; ++c)
      all = all && body.min[c] <= domain.min[c] && body.max[c] >= domain.max[c];
    return all;
  };
  return scene::is_closed(domain) && std::any_of(domain.bodies.begin(), domain.bodies.end(), fills);
}

void full_boxes(const Scene& s, std::vector<std::string>& found) {
  if (!s.terms.pressure || s.flow.solver != scene::FlowSolver::isph) return;
  if (s.flow.free_surface && closed_and_full(s.domain))
    found.push_back(
        "flow.free_surface: true in a box of walls that is full; from 100 g on loose spots are taken for "
        "surface and particles driven into the walls: false");
  if (!s.flow.free_surface && s.flow.shifting == 0)
    found.push_back("flow.shifting: 0 in a full box; its particles lose their order and run away: 4");
  else if (!s.flow.free_surface && s.flow.shifting_speed == 0)
    found.push_back(
        "flow.shifting_speed_m_s: 0 in a full box; brisk convection ran away where it comes to rest: the "
        "speed of the flow");
}

/// Melt under vapour at a front whose film is thinner than a particle: which interface viscosity goes with
/// which temperature of its surface.
void melt_at_the_front(const Scene& s, std::vector<std::string>& found) {
  if (!s.laser || !s.terms.recoil || !s.terms.interface_viscosity) return;
  const bool at_face = s.surface.temperature == scene::SurfaceTemperature::face;
  const double least = std::min(s.flow.interface_viscosity_free, s.flow.interface_viscosity_solid),
               most = std::max(s.flow.interface_viscosity_free, s.flow.interface_viscosity_solid);
  if (at_face && most > kFrontViscosity)
    found.push_back(
        fmt::format("flow.interface_viscosity_*: {:g} with surface.temperature = \"face\"; melt that cannot "
                    "leave the front evaporates there, and depth depends on the spacing: 0.1",
                    most));
  if (!at_face && least < kFrontViscosity)
    found.push_back(fmt::format(
        "flow.interface_viscosity_*: {:g} with surface.temperature = \"particle\"; melt that boils "
        "before it moves is thrown out, with 0.1 a third of it: 1",
        least));
}

void repelling_tension(const Scene& s, std::vector<std::string>& found) {
  if (s.flow.solver == scene::FlowSolver::wcsph && s.terms.recoil &&
      s.flow.tension == scene::Tension::artificial_stress)
    found.push_back(
        "flow.tension: \"artificial_stress\" in melt that vapour pushes; where only viscosity dampens, melt "
        "under a spot of recoil got fifty times the energy of the flow (recoil_spot): \"full\"");
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
  full_boxes(s, found);
  melt_at_the_front(s, found);
  repelling_tension(s, found);
  if (s.laser && scene::is_elastic(s) && s.flow.elastic_modulus_scale > kWeldModulus)
    found.push_back(fmt::format(
        "flow.elastic_modulus_scale: {:g} in a weld; with the whole modulus the solid of aluminium "
        "ran away after 0.2 ms, at half the step too: {:g} or less",
        s.flow.elastic_modulus_scale, kWeldModulus));
  return found;
}

}  // namespace meltray::app
