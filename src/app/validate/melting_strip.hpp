// SPDX-License-Identifier: MIT
#pragma once

#include "app/validate/neumann.hpp"
#include "app/validate/scenes.hpp"

namespace meltray::app {

/// A strip, uniform along z, that melts from its hot wall x_min, against Neumann's solution.
struct MeltedStrip {
  double front = 0, exact_front = 0;  ///< [m]; what is molten, in parts too, gathered at the wall
  double liquid = 0, solid = 0;       ///< L2 of T - T_exact over that of T_exact - T_m and T_exact - T_0
  double budget = 0;                  ///< heat stored against heat from the wall, relative
  double seconds = 0, spacing = 0;
  std::int64_t steps = 0;
};

/// Middle of the melting band [K].
double melting_point(const Material& material);

/// Neumann's solution for the properties and the wall of a scene; `initial` at most the melting point [K].
Neumann neumann(const scene::Scene& scene, double initial);

/// Runs the case of `setting` with some keys changed to the time `end` [s], `spacing` [m], the length along x
/// as in the case. A body that starts at the lower end of the melting band counts as one at
/// the melting point.
MeltedStrip melt_strip(const Setting& setting, double spacing, double end, scene::Overrides overrides);

}  // namespace meltray::app
