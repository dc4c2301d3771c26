// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "meltray/scene/simulation.hpp"

namespace meltray::app::studies {

/// What a study compares: one number, or one entry per particle. Particles keep their index, so two runs of
/// one scene are compared entry by entry.
struct Quantity {
  std::string name;  ///< with its unit
  std::vector<double> values;
};
using Quantities = std::vector<Quantity>;
using Measure = Quantities (*)(const scene::Simulation& simulation);

Quantities no_quantities(const scene::Simulation& simulation);
/// Temperatures of all particles, and the molten mass.
Quantities heat_quantities(const scene::Simulation& simulation);
/// Velocities of all liquid particles, and their kinetic energy.
Quantities flow_quantities(const scene::Simulation& simulation);
/// Both of the above without the molten mass.
Quantities convection_quantities(const scene::Simulation& simulation);
/// Velocities, and height over width of the liquid (root of second moments).
Quantities drop_quantities(const scene::Simulation& simulation);
/// Both depths of the capillary and the energy absorbed so far.
Quantities weld_quantities(const scene::Simulation& simulation);

/// Distance of a quantity from its reference over the size of the reference: root of the sum of squares, of
/// fields about their mean. Infinite where one of them is not finite.
double relative_error(const Quantity& q, const Quantity& reference);

/// Entry by entry mean of the same quantities in several runs.
Quantities mean(const std::vector<Quantities>& runs);

}  // namespace meltray::app::studies
