// SPDX-License-Identifier: MIT
#include "app/validate/cases.hpp"

namespace meltray::app {

const std::vector<ValidationCase>& validation_cases() {
  static const std::vector<ValidationCase> cases = {
      {"fresnel_angles", "absorptance over the angle: formula, traced plate, beam at 10 degrees",
       fresnel_angles},
      {"wedge_absorption", "multiple reflections in a wedge: flat facets and a wedge of particles",
       wedge_absorption},
      {"stefan_two_phase_iron", "melting of solid iron at a hot wall: front and temperatures (Neumann)",
       stefan_two_phase_iron},
      {"taylor_green", "decaying vortices in a periodic box at Re 100: decay, velocity and pressure field",
       taylor_green},
      {"laplace_drop", "drop at rest: Laplace pressure and spurious currents", laplace_drop},
      {"recoil_flat_plate", "pool at rest under a uniform recoil pressure: pressure, wall force, rest",
       recoil_flat_plate},
      {"hydrostatic", "tank at rest: pressure, speed and density, both solvers, both density diffusions",
       hydrostatic},
      {"dam_break_martin_moyce", "collapse of a column: front over time, both solvers",
       dam_break_martin_moyce},
  };
  return cases;
}

}  // namespace meltray::app
