// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>

namespace meltray::constants {

inline constexpr double pi = std::numbers::pi;
inline constexpr double gas_constant = 8.31446261815324;    // J/(mol K)
inline constexpr double stefan_boltzmann = 5.670374419e-8;  // W/(m^2 K^4)
inline constexpr double standard_atmosphere = 101325.0;     // Pa
inline constexpr double standard_gravity = 9.80665;         // m/s^2

}  // namespace meltray::constants
