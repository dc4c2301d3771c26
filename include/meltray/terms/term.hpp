// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "meltray/terms/stage.hpp"

namespace meltray::terms {

/// Rates per patch particle that terms add to; a null pointer means that the field is not evolved.
struct Rates {
  MutField acceleration{};      ///< [m/s^2]
  double* heating = nullptr;    ///< dh/dt [W/kg]
};

/// Powers that cross the boundary of the system, integrated as part of the state so that the energy budget
/// closes with the same Runge-Kutta weights as the enthalpies.
struct Powers {
  double evaporation = 0, radiation = 0, boundary = 0, laser = 0;  ///< [W]
  double evaporated_mass = 0;                                      ///< [kg/s]
};

}  // namespace meltray::terms
