// SPDX-License-Identifier: MIT
#include "scene/keys_build.hpp"

namespace meltray::scene {

namespace {

Need recoil_from_vapour() {
  return {"terms.recoil = true and no surface.recoil_pressure_pa",
          {"terms.recoil", "surface.recoil_pressure_pa"},
          [](const Scene& s, int) { return s.terms.recoil && s.surface.recoil_pressure == 0; }};
}

}  // namespace

std::vector<Key> term_keys() {
  return {
      boolean("terms.conduction", MELTRAY_AT(terms.conduction), "Heat conduction, 1st term of Eq. (4)."),
      boolean("terms.viscosity", MELTRAY_AT(terms.viscosity),
              "Physical viscosity of the melt, 2nd term of Eq. (3)."),
      of_row(boolean("terms.interface_viscosity", MELTRAY_AT(terms.interface_viscosity),
                     "Numerical viscosity at the free surface and next to the solid."),
             "false", &Preset::interface_viscosity, MELTRAY_AT(terms.interface_viscosity)),
      of_row(boolean("terms.artificial_viscosity", MELTRAY_AT(terms.artificial_viscosity),
                     "Numerical viscosity between particles that approach each other."),
             "false", &Preset::artificial_viscosity, MELTRAY_AT(terms.artificial_viscosity)),
      boolean("terms.pressure", MELTRAY_AT(terms.pressure), "Pressure: the material flows."),
      boolean("terms.surface_tension", MELTRAY_AT(terms.surface_tension),
              "Surface tension normal to the surface."),
      boolean("terms.marangoni", MELTRAY_AT(terms.marangoni),
              "Force along the surface where surface tension changes with temperature."),
      boolean("terms.wetting", MELTRAY_AT(terms.wetting),
              "Contact angle of the melt where it meets the solid."),
      boolean("terms.recoil", MELTRAY_AT(terms.recoil), "Recoil pressure of the vapour."),
      boolean("terms.evaporation", MELTRAY_AT(terms.evaporation), "Heat lost with the vapour."),
      boolean("terms.radiation", MELTRAY_AT(terms.radiation), "Heat radiated by the surface."),
      of_row(boolean("terms.buoyancy", MELTRAY_AT(terms.buoyancy), "Buoyancy of hot melt, Eq. (8)."), "false",
             &Preset::buoyancy, MELTRAY_AT(terms.buoyancy)),
      boolean("terms.gravity", MELTRAY_AT(terms.gravity), "Weight of the melt."),
      boolean("terms.melting", MELTRAY_AT(terms.melting), "Solid melts and melt solidifies."),
  };
}

std::vector<Key> flow_keys() {
  const Need pressure = term("pressure", &Terms::pressure);
  const Need isph = solved_by(FlowSolver::isph);
  Need interface = term("interface_viscosity", &Terms::interface_viscosity);
  interface.keys.insert(interface.keys.end(),
                        {"model", "terms.pressure"});  // of a row, where there is a flow
  return {
      number("flow.pressure_tolerance", "", above_to(0, 0.1), MELTRAY_AT(flow.pressure_tolerance),
             "Relative residual at which the pressure solve ends.")
          .only_if(pressure)
          .only_if(isph),
      word<PressureSolver>(
          "flow.pressure_solver",
          {{"conjugate_gradients", PressureSolver::conjugate_gradients},
           {"cholesky", PressureSolver::cholesky}},
          MELTRAY_AT(flow.pressure_solver),
          "\"cholesky\": exactly, by sparse factors (CHOLMOD), to judge the other by; for small scenes.")
          .only_if(pressure)
          .only_if(isph),
      integer("flow.pressure_max_iterations", between(1, 1000000), MELTRAY_AT(flow.pressure_max_iterations),
              "Largest number of iterations of a pressure solve.")
          .only_if(pressure)
          .only_if(isph),
      boolean(
          "flow.free_surface", MELTRAY_AT(flow.free_surface),
          "false: the fluid fills a closed or periodic box; a loose spot in it is not taken for a surface, "
          "and its pressure is without the hydrostatic one.")
          .only_if(pressure)
          .only_if(isph),
      number("flow.drift_time_s", "s", at_least(0), MELTRAY_AT(flow.drift_time),
             "Time in which the projection takes back errors of density; 0: seven spacings at the speed that "
             "the scene implies.")
          .only_if(pressure)
          .only_if(isph),
      number("flow.least_distance", "", between(0, 0.9), MELTRAY_AT(flow.least_distance),
             "Distance, in spacings, below which particles of melt at the free surface are moved apart; 0: "
             "they may overlap.")
          .only_if(pressure)
          .only_if(isph),
      of_row(number("flow.shifting", "", between(0, 100), MELTRAY_AT(flow.shifting),
                    "Coefficient of the velocity that keeps particles evenly spread; 0: off."),
             "0", &Preset::shifting, MELTRAY_AT(flow.shifting))
          .only_if(pressure),
      number("flow.shifting_speed_m_s", "m/s", at_least(0), MELTRAY_AT(flow.shifting_speed),
             "Least speed that shifting reckons with, so that it acts at stagnation points.")
          .only_if({"flow.shifting > 0",
                    {"flow.shifting", "model"},
                    [](const Scene& s, int) { return s.flow.shifting > 0; }}),
      number(
          "flow.reference_speed_m_s", "m/s", at_least(0), MELTRAY_AT(flow.reference_speed),
          "Speed that scales the interface viscosity: the sound speed a weakly compressible model would use.")
          .only_if(interface),
      number("flow.interface_viscosity_free", "", at_least(0), MELTRAY_AT(flow.interface_viscosity_free),
             "Coefficient alpha_LG of the interface viscosity at the free surface.")
          .only_if(interface),
      number("flow.interface_viscosity_solid", "", at_least(0), MELTRAY_AT(flow.interface_viscosity_solid),
             "Coefficient alpha_SL of the interface viscosity next to the solid.")
          .only_if(interface),
      number("flow.interface_viscosity_ramp_k", "K", above(0), MELTRAY_AT(flow.interface_viscosity_ramp),
             "Range above the melting temperature over which alpha_SL fades.")
          .only_if(interface),
  };
}

std::vector<Key> surface_keys() {
  const Need forces = {"terms.surface_tension or terms.recoil",
                       {"terms.surface_tension", "terms.recoil"},
                       [](const Scene& s, int) { return s.terms.surface_tension || s.terms.recoil; }};
  const Need prescribed = {"surface.recoil_pressure_pa > 0",
                           {"surface.recoil_pressure_pa"},
                           [](const Scene& s, int) { return s.surface.recoil_pressure > 0; }};
  const Need hot = {"terms.evaporation, terms.radiation, or terms.recoil of the vapour",
                    {"terms.evaporation", "terms.radiation", "terms.recoil"},
                    [](const Scene& s, int) {
                      return s.terms.evaporation || s.terms.radiation ||
                             (s.terms.recoil && s.surface.recoil_pressure == 0);
                    }};
  return {
      word<SurfaceTemperature>(
          "surface.temperature",
          {{"particle", SurfaceTemperature::particle}, {"face", SurfaceTemperature::face}},
          MELTRAY_AT(surface.temperature),
          "Where the temperature is taken at which surfaces evaporate, radiate and feel recoil: at the "
          "outermost particles, half a spacing below the face, or at the face of melt, from what it absorbs, "
          "loses "
          "and conducts.")
          .only_if(hot),
      word<SurfaceEntry>("surface.entry", {{"csf", SurfaceEntry::csf}, {"pressure", SurfaceEntry::pressure}},
                         MELTRAY_AT(surface.entry),
                         "Surface forces act as volume forces (csf) or as the pressure at the surface.")
          .only_if(forces)
          .only_if(solved_by(FlowSolver::isph)),
      word<RecoilOnset>("surface.recoil_onset",
                        {{"smooth", RecoilOnset::smooth},
                         {"cutoff", RecoilOnset::cutoff},
                         {"ambient", RecoilOnset::ambient}},
                        MELTRAY_AT(surface.recoil_onset),
                        "Recoil below the boiling temperature: as it is, none, or less the ambient pressure.")
          .only_if(recoil_from_vapour()),
      number("surface.recoil_coefficient", "", above_to(0, 1), MELTRAY_AT(surface.recoil_coefficient),
             "Recoil pressure over saturation pressure.")
          .only_if(recoil_from_vapour()),
      number("surface.evaporation_coefficient", "", above_to(0, 1),
             MELTRAY_AT(surface.evaporation_coefficient),
             "Share of the vapour that does not condense again, 1 - beta_r.")
          .only_if(term("evaporation", &Terms::evaporation)),
      number("surface.recoil_pressure_pa", "Pa", at_least(0), MELTRAY_AT(surface.recoil_pressure),
             "Recoil pressure instead of that of the vapour, uniform or of a spot; 0: that of the vapour.")
          .only_if(term("recoil", &Terms::recoil)),
      number("surface.recoil_ramp_s", "s", at_least(0), MELTRAY_AT(surface.recoil_ramp),
             "Time in which recoil_pressure_pa grows from zero.")
          .only_if(prescribed),
      number("surface.recoil_radius_m", "m", at_least(0), MELTRAY_AT(surface.recoil_radius),
             "Radius of a spot about x = y = 0 where recoil_pressure_pa has fallen to 1/e^2; 0: uniform.")
          .only_if(prescribed),
      number("surface.activation_ramp_k", "K", at_least(0), MELTRAY_AT(surface.activation_ramp),
             "Range above the melting temperature over which surface tension sets in.")
          .only_if(term("surface_tension", &Terms::surface_tension)),
      number("surface.ambient_temperature_k", "K", above_to(0, 1e5), MELTRAY_AT(surface.ambient_temperature),
             "Temperature that the surface radiates to.")
          .only_if(term("radiation", &Terms::radiation)),
  };
}

std::vector<Key> heat_keys() {
  return {
      number("heat.initial_temperature_k", "K", above_to(0, 1e5), MELTRAY_AT(heat.initial_temperature),
             "Temperature at the start of bodies that give none."),
      number("heat.bulk_interval_s", "s", at_least(0), MELTRAY_AT(heat.bulk_interval),
             "Interval at which solid particles away from the melt exchange heat; 0: in every step.")
          .only_if(term("conduction", &Terms::conduction)),
  };
}

}  // namespace meltray::scene
