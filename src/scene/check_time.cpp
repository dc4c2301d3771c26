// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <string>

#include "scene/case_check.hpp"

namespace meltray::scene {

namespace {

void check_order(const Scene& scene, const Document& document) {
  const IntegratorOptions& o = scene.time.integrator;
  const bool euler = o.method == Method::euler, multirate = o.method == Method::multirate;
  if (euler ? o.order != 1 : multirate ? o.order != 3 && o.order != 4 : o.order < 2)
    refuse(document.place("time.order"), "time.order",
           fmt::format("{} with method \"{}\"", o.order, name_of(o.method)),
           euler       ? "1"
           : multirate ? "3 or 4"
                       : "2 to 5");
}

/// Implicit terms need a method with an implicit part, explicit terms one with an explicit part.
void check_partitions(const Scene& scene, const Document& document) {
  struct Choice {
    const char* name;
    bool active;
    PartitionChoice choice;
  };
  const Terms& on = scene.terms;
  const Time& t = scene.time;
  const std::array<Choice, 4> choices = {
      {{"conduction", on.conduction, t.conduction},
       {"viscosity", on.viscosity, t.viscosity},
       {"interface_viscosity", on.interface_viscosity, t.interface_viscosity},
       {"evaporation", on.evaporation || on.radiation, t.evaporation}}};
  for (const Choice& c : choices) {
    const std::string key = std::string("splitting.") + c.name;
    if (!c.active) continue;
    if (t.integrator.method == Method::explicit_rk && c.choice == PartitionChoice::implicit_)
      refuse(document.place(key), key, "\"implicit\" with time.method = \"explicit\"",
             "\"auto\" or \"explicit\"");
    if (t.integrator.method == Method::multirate && c.choice == PartitionChoice::implicit_)
      refuse(document.place(key), key, "\"implicit\" with time.method = \"multirate\"",
             "\"auto\" or \"explicit\"");
    if (t.integrator.method == Method::implicit_rk && c.choice == PartitionChoice::explicit_)
      refuse(document.place(key), key, "\"explicit\" with time.method = \"implicit\"",
             "\"auto\" or \"implicit\"");
  }
}

/// What is never implicit has no place in a method without an explicit part.
void check_implicit(const Scene& scene, const Document& document) {
  if (scene.time.integrator.method != Method::implicit_rk) return;
  const char* term = scene.terms.pressure ? "terms.pressure" : scene.laser ? "a laser" : nullptr;
  if (term)
    refuse(document.place("time.method"), "time.method",
           fmt::format("\"implicit\" with {}, which is explicit", term), "\"imex\" in such a scene");
}

/// Multirate: conduction in slow steps of constant length, everything else in fast ones between them. The
/// projection once a step would leave the fast steps without a pressure.
void check_multirate(const Scene& scene, const Document& document) {
  if (scene.time.integrator.method != Method::multirate) return;
  const std::string with = " with time.method = \"multirate\"";
  if (scene.time.integrator.fixed_step == 0)
    refuse(document.place("time.method"), "time.fixed_step_s", "0" + with, "the slow step, > 0 [s]");
  if (!scene.terms.conduction)
    refuse(document.place("time.method"), "terms.conduction", "false" + with, "true: it is the slow term");
  if (scene.time.conduction == PartitionChoice::explicit_)
    refuse(document.place("splitting.conduction"), "splitting.conduction", "\"explicit\"" + with,
           "\"auto\": it is the slow term");
  const bool projects = scene.terms.pressure && scene.flow.solver == FlowSolver::isph;
  if (projects && scene.flow.projection == Projection::step)
    refuse(document.place("splitting.projection"), "splitting.projection", "\"step\"" + with, "\"stage\"");
}

}  // namespace

void check_time(const Scene& scene, const Document& document) {
  const IntegratorOptions& o = scene.time.integrator;
  check_order(scene, document);
  check_partitions(scene, document);
  check_implicit(scene, document);
  check_multirate(scene, document);
  if (o.fixed_step > scene.time.end)
    refuse(document.place("time.fixed_step_s"), "time.fixed_step_s", fmt::format("{}", o.fixed_step),
           fmt::format("at most time.end_s = {} [s]", scene.time.end));
  if (o.fixed_step > 0 && o.fixed_step < o.min_step)
    refuse(document.place("time.fixed_step_s"), "time.fixed_step_s", fmt::format("{}", o.fixed_step),
           fmt::format("at least time.min_step_s = {} [s]", o.min_step));
  if (o.fixed_step > 0) return;
  if (o.min_step >= scene.time.end)
    refuse(document.place("time.min_step_s"), "time.min_step_s", fmt::format("{}", o.min_step),
           fmt::format("less than time.end_s = {} [s]", scene.time.end));
  if (o.min_step >= o.max_step)
    refuse(document.place("time.min_step_s"), "time.min_step_s", fmt::format("{}", o.min_step),
           fmt::format("less than time.max_step_s = {} [s]", o.max_step));
  if (o.initial_step > 0 && (o.initial_step < o.min_step || o.initial_step > o.max_step))
    refuse(document.place("time.initial_step_s"), "time.initial_step_s", fmt::format("{}", o.initial_step),
           fmt::format("time.min_step_s to time.max_step_s: {} to {} [s]", o.min_step, o.max_step));
}

}  // namespace meltray::scene
