// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "meltray/particles/particles.hpp"

namespace meltray::app {

/// Temperature of the surface x = 0 of a lattice [K]: layer means extrapolated from the two outermost layers.
double surface_temperature(const Particles& particles, double spacing);

/// State of a half-space that loses heat through its surface.
struct CooledHalfSpace {
  double surface = 0;  ///< temperature of the surface [K]
  double lost = 0;     ///< heat that has left through it [J/m^2]
};

/// A half-space of constant properties, at `initial` [K] at first, whose surface loses flux(T) [W/m^2], after
/// `time` [s]. Duhamel's integral of the response to a flux (Carslaw & Jaeger 1959, sect. 2.9),
///   T(t) = T_0 - 1 / (sqrt(pi) e) int_0^t q(T(s)) / sqrt(t - s) ds,
/// with q linear over each of `steps` intervals. `effusivity` e = sqrt(lambda rho c) [W s^(1/2)/(m^2 K)];
/// flux must not fall with T.
CooledHalfSpace cool_half_space(double effusivity, double initial, double time, int steps,
                                const std::function<double(double)>& flux);

}  // namespace meltray::app
