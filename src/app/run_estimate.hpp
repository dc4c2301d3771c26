// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include "meltray/scene/simulation.hpp"

/// What `meltray check` says of the run time, and the form of its lines.
namespace meltray::app {

inline void heading(const char* text) {
  fmt::print("\n# {}\n", text);
}
inline void line(const std::string& name, const std::string& value) {
  fmt::print("  {:<34} {}\n", name, value);
}

/// Prints steps, cost of a step and run time of a scene whose shortest step limit is `step` [s] (0: none).
void print_run_time(const scene::Simulation& simulation, double step);

}  // namespace meltray::app
