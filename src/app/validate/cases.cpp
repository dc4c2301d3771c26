// SPDX-License-Identifier: MIT
#include "app/validate/cases.hpp"

namespace meltray::app {

const std::vector<ValidationCase>& validation_cases() {
  static const std::vector<ValidationCase> cases = {
      {1, "fresnel_angles", "absorptance over the angle: formula, traced plate, beam at 10 degrees",
       fresnel_angles},
      {1, "wedge_absorption", "multiple reflections in a wedge: flat facets and a wedge of particles",
       wedge_absorption},
      {1, "gouffe_cavity", "matt cavities: absorptance against radiosity and Gouffe's formula",
       gouffe_cavity},
      {1, "stefan_one_phase", "melting at the melting point from a hot wall, St 0.041 to 2.85: front",
       stefan_one_phase},
      {1, "stefan_two_phase_iron", "melting of solid iron at a hot wall: front and temperatures (Neumann)",
       stefan_two_phase_iron},
      {1, "stefan_two_phase_aluminium", "the same for aluminium", stefan_two_phase_aluminium},
      {1, "surface_flux", "constant flux on a half-space: temperature of the surface", surface_flux},
      {1, "surface_losses", "evaporation and radiation from a half-space: heat lost, surface temperature",
       surface_losses},
      {1, "rosenthal", "moving point source on a half-space: temperature behind it", rosenthal},
      {2, "poiseuille_startup", "start of the flow between plates under its weight", poiseuille_startup},
      {2, "couette_startup", "start of the flow between plates of which one moves", couette_startup},
      {2, "taylor_green", "decaying vortices in a periodic box at Re 100: decay, velocity and pressure field",
       taylor_green},
      {1, "laplace_drop", "drop at rest: Laplace pressure and spurious currents", laplace_drop},
      {1, "oscillating_drop", "second mode of a drop: Rayleigh's frequency, damping", oscillating_drop},
      {1, "contact_angle", "drop on a plane: angle, height and base", contact_angle},
      {1, "marangoni_cavity", "thermocapillary flow in a shallow layer: profile in the middle",
       marangoni_cavity},
      {1, "recoil_flat_plate", "pool at rest under a uniform recoil pressure: pressure, wall force, rest",
       recoil_flat_plate},
      {1, "recoil_spot", "film and pool under a spot of recoil pressure: energy of the flow that it starts",
       recoil_spot},
      {1, "constrained_expansion", "heated elastic block between walls: thermal stress, free expansion",
       constrained_expansion},
      {1, "elastic_plate", "clamped elastic plate that swings: period, amplitude, damping", elastic_plate},
      {2, "natural_convection", "heated square cavity, Ra 1e3 to 1e5: Nusselt number, speeds",
       natural_convection},
      {2, "expansion_convection", "heated open tank, WCSPH: thermal expansion against Boussinesq's buoyancy",
       expansion_convection},
      {2, "gallium_melting", "melting from a hot wall with convection: liquid share and front over time",
       gallium_melting},
      {2, "hydrostatic", "tank at rest: pressure, speed and density, both solvers, both density diffusions",
       hydrostatic},
      {2, "sound_wave",
       "standing wave of sound: period and amplitude, WCSPH with each density diffusion and artificial "
       "viscosity",
       sound_wave},
      {2, "shear_wave", "shear wave under artificial viscosity: its viscosity on the lattice", shear_wave},
      {2, "dam_break_martin_moyce", "collapse of a column: front over time, both solvers",
       dam_break_martin_moyce},
      {2, "dam_break_lobovsky",
       "collapse of a column onto a wall: pressure and time of the impact, both solvers", dam_break_lobovsky},
      {3, "absorptance_nist_316l",
       "spot welds of 316L: absorbed share and start of the capillary over intensity", absorptance_nist_316l,
       absorptance_nist_316l_welds},
      {3, "keyhole_depth_xray", "bare plates of 316L, Ti-6Al-4V, Al 6061: depth of the capillary over power",
       keyhole_depth_xray, keyhole_depth_xray_welds},
  };
  return cases;
}

}  // namespace meltray::app
