// SPDX-License-Identifier: MIT
#include "meltray/materials/material.hpp"

#include <algorithm>
#include <cmath>

#include "meltray/core/constants.hpp"

namespace meltray {

namespace {

constexpr double kRoomTemperature = 293.15;

/// Largest value over [low, high]; every form is monotone between its clamps.
double largest(const Property& property, double low, double high) {
  return std::max(property(low), property(high));
}

}  // namespace

double Material::enthalpy_solidus() const {
  return heat_capacity_solid * solidus;
}

// The band stores the latent heat and the sensible heat of the mean heat capacity.
double Material::enthalpy_liquidus() const {
  const double mean_heat_capacity = 0.5 * (heat_capacity_solid + heat_capacity_liquid);
  return enthalpy_solidus() + latent_heat_fusion + mean_heat_capacity * (liquidus - solidus);
}

double Material::enthalpy(double temperature) const {
  if (temperature <= solidus) return heat_capacity_solid * temperature;
  const double h_s = enthalpy_solidus(), h_l = enthalpy_liquidus();
  if (temperature >= liquidus) return h_l + heat_capacity_liquid * (temperature - liquidus);
  return h_s + (h_l - h_s) * (temperature - solidus) / (liquidus - solidus);
}

double Material::temperature(double enthalpy) const {
  const double h_s = enthalpy_solidus();
  if (enthalpy <= h_s) return enthalpy / heat_capacity_solid;
  const double h_l = enthalpy_liquidus();
  if (enthalpy >= h_l) return liquidus + (enthalpy - h_l) / heat_capacity_liquid;
  return solidus + (liquidus - solidus) * (enthalpy - h_s) / (h_l - h_s);
}

double Material::temperature_slope(double enthalpy) const {
  const double h_s = enthalpy_solidus();
  if (enthalpy <= h_s) return 1 / heat_capacity_solid;
  const double h_l = enthalpy_liquidus();
  if (enthalpy >= h_l) return 1 / heat_capacity_liquid;
  return (liquidus - solidus) / (h_l - h_s);
}

double Material::liquid_fraction(double enthalpy) const {
  const double h_s = enthalpy_solidus();
  if (enthalpy <= h_s) return 0;
  const double h_l = enthalpy_liquidus();
  return enthalpy >= h_l ? 1 : (enthalpy - h_s) / (h_l - h_s);
}

double Material::conductivity(double enthalpy) const {
  const double t = temperature(enthalpy);
  const double liquid = liquid_fraction(enthalpy);
  if (liquid == 0) return conductivity_solid(t);
  if (liquid == 1) return conductivity_liquid(t);
  return (1 - liquid) * conductivity_solid(t) + liquid * conductivity_liquid(t);
}

double Material::sigma(double temperature) const {
  return std::max(surface_tension(temperature), surface_tension_floor);
}

double Material::sigma_slope(double temperature) const {
  return surface_tension(temperature) > surface_tension_floor ? surface_tension.slope(temperature) : 0;
}

double Material::saturation_pressure(double temperature) const {
  if (temperature <= 0) return 0;  // the limit for T -> 0
  const double theta = latent_heat_vaporisation * molar_mass / constants::gas_constant;
  return constants::standard_atmosphere * std::exp(theta * (1 / boiling_temperature - 1 / temperature));
}

double Material::saturation_pressure_slope(double temperature) const {
  if (temperature <= 0) return 0;
  const double theta = latent_heat_vaporisation * molar_mass / constants::gas_constant;
  return saturation_pressure(temperature) * theta / (temperature * temperature);
}

double Material::thermal_diffusivity_max() const {
  const double solid = largest(conductivity_solid, kRoomTemperature, solidus) / heat_capacity_solid;
  const double liquid = largest(conductivity_liquid, liquidus, boiling_temperature) / heat_capacity_liquid;
  return std::max(solid, liquid) / density;
}

}  // namespace meltray
