// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <string>
#include <string_view>
#include <vector>

namespace meltray {

/// A property as a function of temperature, held at its end values outside [t_min, t_max].
struct Property {
  enum class Form { constant, linear, andrade };
  Form form = Form::constant;
  double a = 0;      ///< constant: the value; linear: value at t_ref; andrade: exponent offset
  double b = 0;      ///< linear: slope per K; andrade: temperature coefficient [K]
  double t_ref = 0;  ///< linear only [K]
  double t_min = 0, t_max = 1e9;

  /// constant: a; linear: a + b (T - t_ref); andrade: 10^(a + b/T).
  double operator()(double temperature) const;
  /// d/dT; zero where the end value is held.
  double slope(double temperature) const;
};

inline Property constant(double value) {
  return {Property::Form::constant, value};
}
inline Property linear(double value, double slope, double t_ref, double t_min = 0, double t_max = 1e9) {
  return {Property::Form::linear, value, slope, t_ref, t_min, t_max};
}
inline Property andrade(double a, double b, double t_min, double t_max) {
  return {Property::Form::andrade, a, b, 0, t_min, t_max};
}

/// A pure metal or an effective set for an alloy. SI units; T in K.
struct Material {
  std::string name;
  double density = 0;     ///< constant reference density of both phases (ISPH) [kg/m^3]
  Property density_of_t;  ///< liquid density rho_0(T) [kg/m^3]
  double heat_capacity_solid = 0, heat_capacity_liquid = 0;  ///< [J/(kg K)]
  Property conductivity_solid, conductivity_liquid;          ///< [W/(m K)]
  double solidus = 0, liquidus = 0;                          ///< melting band [K], solidus < liquidus
  double latent_heat_fusion = 0;                             ///< [J/kg]
  double boiling_temperature = 0;                            ///< at one standard atmosphere [K]
  double latent_heat_vaporisation = 0;                       ///< [J/kg]
  double molar_mass = 0;                                     ///< [kg/mol]
  Property viscosity;                                        ///< dynamic, of the liquid [Pa s]
  Property surface_tension;                                  ///< before the floor [N/m]
  double surface_tension_floor = 0;                          ///< [N/m]; d sigma/dT is zero where it acts
  double expansion = 0;                                      ///< volumetric, of the liquid (Boussinesq) [1/K]
  double expansion_reference = 0;                            ///< T_0 of Eq. (8) [K]
  double linear_expansion_solid = 0;                         ///< [1/K]
  double youngs_modulus = 0;                                 ///< of the solid [Pa]
  double poisson_ratio = 0;                                  ///< of the solid
  double emissivity = 0;                                     ///< of the surface
  double contact_angle_deg = 10;                             ///< of the melt on its own solid
  /// n + ik at the laser wavelength; (1, 0) where none is known (see has_index()).
  std::complex<double> index_solid{1, 0}, index_liquid{1, 0};

  /// Specific enthalpy: c_s T below the solidus, linear through the band with the latent heat, c_l above.
  double enthalpy(double temperature) const;
  /// Inverse of enthalpy(); strictly monotone.
  double temperature(double enthalpy) const;
  /// dT/dh at an enthalpy [K kg/J].
  double temperature_slope(double enthalpy) const;
  double enthalpy_solidus() const;
  double enthalpy_liquidus() const;
  /// Fraction of liquid, 0 at or below the solidus, 1 at or above the liquidus.
  double liquid_fraction(double enthalpy) const;
  /// Conductivity, blended over the melting band by the liquid fraction [W/(m K)].
  double conductivity(double enthalpy) const;
  double sigma(double temperature) const;        ///< surface tension with its floor [N/m]
  double sigma_slope(double temperature) const;  ///< d sigma/dT [N/(m K)]; zero at the floor
  /// Clausius-Clapeyron: p_0 exp[(L_v M/R)(1/T_b - 1/T)] [Pa].
  double saturation_pressure(double temperature) const;
  double saturation_pressure_slope(double temperature) const;  ///< d p_sat/dT [Pa/K]
  /// Largest lambda/(rho c) of the two phases, from room temperature to the boiling point [m^2/s].
  double thermal_diffusivity_max() const;
  /// False where no optical constants are known: a laser then needs a fixed absorptance.
  bool has_index() const { return index_solid != 1.0 && index_liquid != 1.0; }
};

/// Names of the built-in materials, in the order `meltray list materials` shows them.
std::vector<std::string> material_names();
/// Built-in material by name. Throws UsageError (with the nearest known name) for an unknown one.
Material material_by_name(std::string_view name);
/// One line about a built-in material: what it is and where the numbers come from.
std::string material_summary(std::string_view name);

}  // namespace meltray
