// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "meltray/scene/scene.hpp"

namespace meltray::scene {

/// A row of Table 1 of the paper and the choices that go with it. `model` in a case file picks a row; each
/// key given in the case outweighs it.
struct Preset {
  std::string_view model;
  FlowSolver solver = FlowSolver::isph;
  bool artificial_viscosity = false, interface_viscosity = false;
  bool thermal_expansion = false, buoyancy = false;
  SolidModel solid = SolidModel::fixed;
  double shifting = 0;
};

/// Rows in the order of Table 1.
const std::vector<Preset>& presets();
/// Throws std::logic_error for a name that is no row.
const Preset& preset_of(std::string_view model);

/// Where a scene stands in Table 1: "wcsph_reduced", or the nearest row and what differs from it.
std::string row_of_table(const Scene& scene);

}  // namespace meltray::scene
