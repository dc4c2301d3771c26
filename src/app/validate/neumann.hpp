// SPDX-License-Identifier: MIT
#pragma once

namespace meltray::app {

/// Melting of a half-space from an isothermal wall with constant properties and one density (Neumann's
/// similarity solution; Alexiades & Solomon 1993, sect. 2.2):
///   T_l = T_w - (T_w - T_m) erf(x / (2 sqrt(a_l t))) / erf(l),
///   T_s = T_0 + (T_m - T_0) erfc(x / (2 sqrt(a_s t))) / erfc(l sqrt(a_l / a_s)),   X = 2 l sqrt(a_l t).
struct Neumann {
  double density, latent_heat;
  double conductivity_liquid, heat_capacity_liquid, conductivity_solid, heat_capacity_solid;
  double wall, melting, initial;  ///< temperatures [K]

  double diffusivity_liquid() const { return conductivity_liquid / (density * heat_capacity_liquid); }
  double diffusivity_solid() const { return conductivity_solid / (density * heat_capacity_solid); }
  /// l, from the balance of heat at the front, by bisection.
  double lambda() const;
  double front(double t) const;  ///< [m]
  double temperature(double x, double t) const;
};

}  // namespace meltray::app
