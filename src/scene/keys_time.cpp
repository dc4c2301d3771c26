// SPDX-License-Identifier: MIT
#include "scene/keys_build.hpp"

namespace meltray::scene {

namespace {

Need free_steps() {
  return {"time.fixed_step_s = 0", {"time.fixed_step_s"}, [](const Scene& s, int) {
            return s.time.integrator.fixed_step == 0;
          }};
}

Need error_control() {
  return {"error control: time.fixed_step_s = 0 and time.method other than \"euler\"",
          {"time.fixed_step_s", "time.method"},
          [](const Scene& s, int) {
            return s.time.integrator.fixed_step == 0 && s.time.integrator.method != Method::euler;
          }};
}

Need multirate() {
  return {"time.method = \"multirate\"", {"time.method"}, [](const Scene& s, int) {
            return s.time.integrator.method == Method::multirate;
          }};
}

Key method() {
  return word<Method>(
      "time.method",
      {{"euler", Method::euler},
       {"imex", Method::imex},
       {"explicit", Method::explicit_rk},
       {"implicit", Method::implicit_rk},
       {"multirate", Method::multirate}},
      MELTRAY_AT(time.integrator.method),
      "Forward-backward Euler, or Runge-Kutta: implicit-explicit, explicit, implicit, or conduction in "
      "slow steps and the flow in fast ones.");
}

std::vector<Key> step_keys() {
  const auto at = [](auto member) {
    return [member](auto& s, int) -> auto& {
      return s.time.integrator.*member;
    };
  };
  using Options = IntegratorOptions;
  return {
      number("time.end_s", "s", above(0), MELTRAY_AT(time.end), "End of the run.").required(),
      method(),
      integer("time.order", between(1, 5), at(&Options::order),
              "Order of the method: 1 for euler, 3 or 4 for multirate, else 2 to 5.")
          .otherwise("2; 1 for euler; 3 for multirate",
                     [](Scene& s, int, const Document&) {
                       const Method m = s.time.integrator.method;
                       s.time.integrator.order = m == Method::euler ? 1 : m == Method::multirate ? 3 : 2;
                     }),
      number("time.fixed_step_s", "s", at_least(0), at(&Options::fixed_step),
             "Constant step without error control and without step limits; 0: steps are chosen. With "
             "multirate the "
             "slow step, which has to be given."),
      number("time.fast_step_s", "s", at_least(0), at(&Options::fast_step),
             "Largest step of the fast part; 0: its step limits.")
          .only_if(multirate()),
      number("time.initial_step_s", "s", at_least(0), at(&Options::initial_step),
             "First step; 0: chosen from the step limits.")
          .only_if(free_steps()),
      number_or_unlimited("unlimited", "time.max_step_s", "s", above(0), at(&Options::max_step),
                          "Largest step.")
          .only_if(free_steps()),
      number("time.min_step_s", "s", above(0), at(&Options::min_step),
             "The run fails where it would need a smaller step.")
          .only_if(free_steps()),
      number("time.safety", "", above_to(0, 1), at(&Options::safety),
             "Share of the step that error control would allow.")
          .only_if(error_control()),
      number("time.max_growth", "", above_to(1, 100), at(&Options::max_growth),
             "Largest ratio of a step to the one before.")
          .only_if(free_steps()),
  };
}

std::vector<Key> accuracy_keys() {
  std::vector<Key> keys = {
      number("time.rtol", "", above_to(0, 0.5), MELTRAY_AT(time.rtol), "Relative error allowed in a step."),
      number("time.atol_position", "spacing", above(0), MELTRAY_AT(time.atol_position),
             "Absolute error of positions allowed in a step."),
      number("time.atol_velocity_m_s", "m/s", above(0), MELTRAY_AT(time.atol_velocity),
             "Absolute error of velocities allowed in a step."),
      number("time.atol_density", "density", above(0), MELTRAY_AT(time.atol_density),
             "Absolute error of densities allowed in a step.")
          .only_if(solved_by(FlowSolver::wcsph)),
      number("time.atol_temperature_k", "K", above(0), MELTRAY_AT(time.atol_temperature),
             "Absolute error of temperatures allowed in a step."),
  };
  for (Key& key : keys) key.needs.push_back(error_control());
  return keys;
}

std::vector<Key> limit_keys() {
  const Need tension = term("surface_tension", &Terms::surface_tension);
  const Need viscous = {"terms.viscosity or terms.interface_viscosity",
                        {"terms.viscosity", "terms.interface_viscosity"},
                        [](const Scene& s, int) { return s.terms.viscosity || s.terms.interface_viscosity; }};
  const Need beam = {"[laser]", {}, [](const Scene& s, int) { return s.laser.has_value(); }};
  const Range range = above_to(0, 10);
  std::vector<Key> keys = {
      number("time.cfl_acoustic", "", range, MELTRAY_AT(time.cfl_acoustic), "Step over h / (c + |v|).")
          .only_if(solved_by(FlowSolver::wcsph)),
      number("time.cfl_advective", "", range, MELTRAY_AT(time.cfl_advective), "Step over h / |v|."),
      number("time.cfl_capillary", "", range, MELTRAY_AT(time.cfl_capillary),
             "Step over sqrt(rho h^3 / (2 pi sigma)).")
          .only_if(tension),
      number("time.cfl_viscous", "", range, MELTRAY_AT(time.cfl_viscous),
             "Step of explicit viscosity over its stability bound (Gershgorin).")
          .only_if(viscous),
      number("time.cfl_thermal", "", range, MELTRAY_AT(time.cfl_thermal),
             "Step of explicit conduction over its stability bound (Gershgorin).")
          .only_if(term("conduction", &Terms::conduction)),
      number("time.cfl_force", "", range, MELTRAY_AT(time.cfl_force), "Step over sqrt(h / |a|)."),
      number("time.beam_travel", "focal radius", range, MELTRAY_AT(time.beam_travel),
             "Way of the beam in one step.")
          .only_if(beam),
      number("time.laser_heating_k", "K", above(0), MELTRAY_AT(time.laser_heating),
             "Largest rise of a particle's temperature in one step by the light that it absorbs, over the "
             "solid's heat capacity: light stands still over a step, and error control does not see it.")
          .only_if(beam),
  };
  const Need limited = {"time.fixed_step_s = 0, or time.method = \"multirate\" with time.fast_step_s = 0",
                        {"time.fixed_step_s", "time.method", "time.fast_step_s"},
                        [](const Scene& s, int) {
                          const IntegratorOptions& o = s.time.integrator;
                          return o.fixed_step == 0 || (o.method == Method::multirate && o.fast_step == 0);
                        }};
  for (Key& key : keys) key.needs.push_back(limited);
  return keys;
}

Key partition(const char* name, PartitionChoice Time::*member, const char* sentence, Need need) {
  return word<PartitionChoice>(
             std::string("splitting.") + name,
             {{"auto", PartitionChoice::automatic},
              {"explicit", PartitionChoice::explicit_},
              {"implicit", PartitionChoice::implicit_}},
             [member](auto& s, int) -> auto& { return s.time.*member; }, sentence)
      .only_if(std::move(need));
}

std::vector<Key> splitting_keys() {
  const Need cooling = {"terms.evaporation or terms.radiation",
                        {"terms.evaporation", "terms.radiation"},
                        [](const Scene& s, int) { return s.terms.evaporation || s.terms.radiation; }};
  const Need implicit = {
      "a time.method other than \"explicit\" and \"multirate\"", {"time.method"}, [](const Scene& s, int) {
        const Method m = s.time.integrator.method;
        return m != Method::explicit_rk && m != Method::multirate;
      }};
  return {
      partition("conduction", &Time::conduction,
                "Where heat conduction is integrated; auto: the cheaper side.",
                term("conduction", &Terms::conduction)),
      partition("viscosity", &Time::viscosity, "Where physical viscosity is integrated.",
                term("viscosity", &Terms::viscosity)),
      partition("interface_viscosity", &Time::interface_viscosity, "Where interface viscosity is integrated.",
                term("interface_viscosity", &Terms::interface_viscosity)),
      partition("evaporation", &Time::evaporation,
                "Where heat loss by evaporation and radiation is integrated.", cooling),
      word<Projection>(
          "splitting.projection", {{"step", Projection::step}, {"stage", Projection::stage}},
          MELTRAY_AT(flow.projection),
          "Pressure is solved for once after each step, or in every stage (which keeps the order).")
          .only_if(term("pressure", &Terms::pressure))
          .only_if(solved_by(FlowSolver::isph)),
      number("splitting.linear_tolerance", "", above_to(0, 0.1), MELTRAY_AT(time.linear_tolerance),
             "Relative residual at which implicit solves end.")
          .only_if(implicit),
  };
}

}  // namespace

std::vector<Key> time_keys() {
  std::vector<Key> keys = step_keys();
  append(keys, accuracy_keys());
  append(keys, limit_keys());
  append(keys, splitting_keys());
  return keys;
}

std::vector<Key> output_keys() {
  return {
      number("output.interval_s", "s", above(0), MELTRAY_AT(output.interval),
             "Interval of the rows of history.csv.")
          .required(),
      number("output.snapshot_interval_s", "s", at_least(0), MELTRAY_AT(output.snapshot_interval),
             "Interval of the particle files; 0: at the start and the end only."),
      number("output.checkpoint_interval_s", "s", at_least(0), MELTRAY_AT(output.checkpoint_interval),
             "Interval of checkpoints; 0: at the end only."),
  };
}

}  // namespace meltray::scene
