// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "meltray/terms/stage.hpp"

namespace meltray::terms {

/// Rates per patch particle that terms add to; a null pointer means that the field is not evolved.
struct Rates {
  MutField acceleration{};          ///< [m/s^2]
  double* heating = nullptr;        ///< dh/dt [W/kg]
  double* density = nullptr;        ///< d rho/dt [kg/(m^3 s)]
  std::array<double*, 6> stress{};  ///< dS/dt, upper triangle [Pa/s]
};

/// What crosses the boundary of the system or changes the melt's momentum, integrated as part of the state so
/// that the budgets close with the same Runge-Kutta weights as the fields.
struct Crossings {
  double evaporation = 0, radiation = 0, boundary = 0, laser = 0;  ///< [W]
  double evaporated_mass = 0;                                      ///< [kg/s]
  /// Force on all moving particles together, by cause [N]; `surface` is the Marangoni stress.
  Vec3 gravity = Vec3::Zero(), surface = Vec3::Zero(), viscosity = Vec3::Zero(), shifting = Vec3::Zero(),
       pressure = Vec3::Zero();

  static constexpr std::size_t kCount = 20;
  void write(double* out) const;
  static Crossings read(const double* in);
};

}  // namespace meltray::terms
