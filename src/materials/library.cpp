// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>

#include "meltray/core/errors.hpp"
#include "meltray/core/nearest.hpp"
#include "meltray/materials/material.hpp"

// Sources of the numbers, as marked behind each:
//   [A06]  Assael et al. 2006, J. Phys. Chem. Ref. Data 35, 285 (density and viscosity of liquid Al and Fe)
//   [R95]  Rakic 1995, Appl. Opt. 34, 4755 (optical constants of aluminium)
//   [Q85]  Querry 1985 (optical constants of iron)
//   [G21]  Gan et al. 2021, Nat. Commun., effective constants in the data of its keyhole scaling
//   [LBF]  laserbeamFoam, [LET] lethe: values in the examples of these public codes
//   [MPC]  value common to public melt-pool codes, not traced to a measurement
//   [HB]   handbook value, not checked against a primary source
//   [ASM]  assumption of this project

namespace meltray {

namespace {

/// Width of the artificial melting band of pure metals and of sets that state one melting temperature [ASM].
constexpr double kBand = 5;

void set_melting_point(Material& m, double melting_temperature) {
  m.solidus = melting_temperature - kBand / 2;
  m.liquidus = melting_temperature + kBand / 2;
}

void set_surface_tension(Material& m, double value, double slope, double t_ref) {
  m.surface_tension = linear(value, slope, t_ref);
  m.surface_tension_floor = 0.1 * value;  // [ASM]: the linear laws are not meant to reach zero
}

Material iron() {
  constexpr double t_m = 1811;  // [HB], anchor of the fits of [A06]
  constexpr double t_b = 3134;  // [HB], [LBF]
  Material m;
  m.name = "iron";
  m.density = 7035;                                         // [A06] at T_m
  m.density_of_t = linear(7034.96, -0.926, t_m, t_m, t_b);  // [A06]: data to 2480 K, then extrapolated
  m.heat_capacity_solid = 690;                              // [HB], mean over 300 K to T_m
  m.heat_capacity_liquid = 824;                             // [MPC]; 46.0 J/(mol K) [HB]
  m.conductivity_solid = constant(34);                      // [HB], mean below T_m
  m.conductivity_liquid = constant(36);                     // [HB]
  set_melting_point(m, t_m);
  m.latent_heat_fusion = 247e3;  // [HB] 13.81 kJ/mol
  m.boiling_temperature = t_b;
  m.latent_heat_vaporisation = 6.09e6;                 // [HB] 340 kJ/mol, [LBF]
  m.molar_mass = 0.055845;                             // [HB]
  m.viscosity = andrade(-3.7209, 2694.95, t_m, 2500);  // form of [A06], coefficients [HB]
  set_surface_tension(m, 1.87, -4.3e-4, t_m);          // [MPC]; Keene 1993 has 1.862, -3.9e-4
  m.expansion = 1.32e-4;                               // 0.926/7035 of [A06]
  m.expansion_reference = t_m;
  m.linear_expansion_solid = 12e-6;                 // [HB] at 300 K
  m.youngs_modulus = 211e9;                         // [HB] at 300 K
  m.poisson_ratio = 0.29;                           // [HB] at 300 K
  m.emissivity = 0.5;                               // [MPC]; 0.3 to 0.5 [HB]
  m.index_solid = m.index_liquid = {2.927, 4.377};  // [Q85] solid, 1.07 um
  return m;
}

Material aluminium() {
  constexpr double t_m = 933.47;  // [HB], anchor of the fits of [A06]
  constexpr double t_b = 2792;    // [HB]; handbooks spread from 2743 to 2793
  Material m;
  m.name = "aluminium";
  m.density = 2377;                                         // [A06] at T_m
  m.density_of_t = linear(2377.23, -0.311, t_m, t_m, t_b);  // [A06]: data to 1190 K, then extrapolated
  m.heat_capacity_solid = 1000;                             // [HB], mean over 300 K to T_m
  m.heat_capacity_liquid = 1177;                            // [HB]
  m.conductivity_solid = constant(220);                     // [HB], mean below T_m
  m.conductivity_liquid = constant(94);                     // [HB]
  set_melting_point(m, t_m);
  m.latent_heat_fusion = 397e3;  // [HB]
  m.boiling_temperature = t_b;
  m.latent_heat_vaporisation = 10.5e6;                // [HB], [G21] has 10.53e6 for Al 6061
  m.molar_mass = 0.0269815;                           // [HB]
  m.viscosity = andrade(-3.7324, 803.49, t_m, 2500);  // form of [A06], coefficients [HB]
  set_surface_tension(m, 0.86, -1.34e-4, t_m);        // [MPC], a surface with oxide
  m.expansion = 1.31e-4;                              // 0.311/2377 of [A06]
  m.expansion_reference = t_m;
  m.linear_expansion_solid = 23.1e-6;  // [HB] at 300 K
  m.youngs_modulus = 70e9;             // [HB] at 300 K
  m.poisson_ratio = 0.345;             // [HB] at 300 K
  m.emissivity = 0.15;                 // [HB], liquid: 0.1 to 0.2
  m.index_solid = {1.400, 9.891};      // [R95], 1.033 um
  m.index_liquid = {3.21, 11.33};      // free-electron Drude, 3 electrons an atom, 0.24 uOhm m (T_m), 1.07 um
  return m;
}

/// What the effective sets of [G21] have in common: one value for both phases, no expansion data.
Material effective_set(double density, double heat_capacity, double conductivity, double liquidus) {
  Material m;
  m.density = density;
  m.density_of_t = constant(density);
  m.heat_capacity_solid = m.heat_capacity_liquid = heat_capacity;
  m.conductivity_solid = m.conductivity_liquid = constant(conductivity);
  m.solidus = liquidus - kBand;
  m.liquidus = liquidus;
  m.expansion_reference = liquidus;
  m.emissivity = 0.4;  // [ASM]
  return m;
}

Material ss316() {
  Material m = effective_set(6881, 790, 26.9, 300 + 1430);  // [G21], T_l - T_0 with T_0 = 300 K
  m.name = "ss316";
  m.latent_heat_fusion = 260e3;                     // [G21]
  m.boiling_temperature = 300 + 2829;               // [G21]
  m.latent_heat_vaporisation = 6.336e6;             // [G21]
  m.molar_mass = 0.0558;                            // [ASM]
  m.viscosity = constant(6e-3);                     // [ASM]
  set_surface_tension(m, 1.8, -4e-4, m.liquidus);   // [ASM]
  m.index_solid = m.index_liquid = {2.927, 4.377};  // [ASM]: that of iron, [Q85]
  return m;
}

Material ti64() {
  Material m = effective_set(3920, 830, 33.4, 300 + 1630);  // [G21], T_l - T_0 with T_0 = 300 K
  m.name = "ti64";
  m.latent_heat_fusion = 286e3;                       // [G21]
  m.boiling_temperature = 300 + 3267;                 // [G21]
  m.latent_heat_vaporisation = 9.255e6;               // [G21]
  m.molar_mass = 0.0458;                              // [LET]
  m.viscosity = constant(3.5e-3);                     // [ASM]
  set_surface_tension(m, 1.52, -5.5e-4, m.liquidus);  // [LET], there at 1928 K
  return m;                                           // no optical constants: absorptance near 0.35 [LET]
}

Material al6061() {
  Material m = effective_set(2415, 1170, 90, 300 + 622);  // [G21], T_l - T_0 with T_0 = 300 K
  m.name = "al6061";
  m.latent_heat_fusion = 380e3;                       // [G21]
  m.boiling_temperature = 300 + 2499;                 // [G21]
  m.latent_heat_vaporisation = 10.53e6;               // [G21]
  m.molar_mass = 0.0270;                              // [ASM]
  m.viscosity = constant(1.3e-3);                     // [ASM]
  set_surface_tension(m, 0.87, -1.5e-4, m.liquidus);  // [ASM]
  m.emissivity = 0.15;                                // [ASM]: that of liquid aluminium
  const Material pure = aluminium();
  m.index_solid = pure.index_solid;    // [ASM]
  m.index_liquid = pure.index_liquid;  // [ASM]
  return m;
}

struct Entry {
  const char* name;
  Material (*make)();
  const char* summary;
};

constexpr std::array<Entry, 5> kLibrary = {{
    {"iron", iron, "pure iron; density and viscosity after Assael 2006, index of Querry 1985 at 1.07 um"},
    {"aluminium", aluminium,
     "pure aluminium; Assael 2006, index of Rakic 1995 (solid) and of a free-electron metal (liquid)"},
    {"ss316", ss316, "effective set for 316 steel of Gan 2021; surface data assumed, index of iron"},
    {"ti64", ti64,
     "effective set for Ti-6Al-4V of Gan 2021; no index known: set a fixed absorptance near 0.35"},
    {"al6061", al6061, "effective set for Al 6061 of Gan 2021; surface data assumed, index of aluminium"},
}};

const Entry& entry(std::string_view name) {
  for (const Entry& e : kLibrary)
    if (name == e.name) return e;
  const auto known = material_names();
  throw UsageError(fmt::format("unknown material \"{}\": nearest is \"{}\"; known materials: {}", name,
                               nearest_name(name, known), fmt::join(known, ", ")));
}

}  // namespace

std::vector<std::string> material_names() {
  std::vector<std::string> names;
  for (const Entry& e : kLibrary) names.emplace_back(e.name);
  return names;
}

Material material_by_name(std::string_view name) {
  return entry(name).make();
}

std::string material_summary(std::string_view name) {
  return entry(name).summary;
}

}  // namespace meltray
