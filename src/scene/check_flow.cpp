// SPDX-License-Identifier: MIT

#include "meltray/scene/elastic.hpp"
#include "scene/case_check.hpp"

namespace meltray::scene {

void check_flow(const Scene& scene, const Document& document) {
  const Flow& flow = scene.flow;
  if (!scene.terms.pressure) return;
  const bool weak = flow.solver == FlowSolver::wcsph;
  if (scene.terms.artificial_viscosity && !weak)
    refuse(document.place("terms.artificial_viscosity"), "terms.artificial_viscosity",
           "true with flow.solver = \"isph\", which has no sound speed", "flow.solver = \"wcsph\" with it");
  if (!weak) return;
  if (flow.sound_speed == 0)
    refuse(document.place("flow.sound_speed_m_s"), "flow.sound_speed_m_s", "0", "a number > 0 [m/s]");
  if (flow.thermal_expansion && scene.terms.buoyancy)
    refuse(document.place("terms.buoyancy"), "terms.buoyancy",
           "true with flow.thermal_expansion = true, which already contains buoyancy", "one of the two");
  const Property& rho = scene.material.density_of_t;
  const bool solid_expands = is_elastic(scene) && scene.material.linear_expansion_solid > 0;
  if (flow.thermal_expansion && !solid_expands &&
      rho(scene.material.liquidus) == rho(scene.material.boiling_temperature + 1e4))
    refuse(document.place("flow.thermal_expansion"), "flow.thermal_expansion",
           "true without effect: the density of this material does not depend on temperature",
           "material.density_of_t_kg_m3 that does, with it");
  if (scene.time.integrator.method == Method::euler)
    refuse(document.place("time.method"), "time.method",
           "\"euler\" with flow.solver = \"wcsph\", where it amplifies sound", "\"imex\" or \"explicit\"");
}

}  // namespace meltray::scene
