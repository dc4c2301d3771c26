// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "meltray/core/constants.hpp"
#include "meltray/materials/material.hpp"

using namespace meltray;

namespace {

/// Evaporating mass flux of kinetic theory (Hertz-Knudsen) with the coefficient 1 - beta_r = 0.82 [kg/(m^2
/// s)].
double mass_flux(const Material& m, double t) {
  return 0.82 * m.saturation_pressure(t) *
         std::sqrt(m.molar_mass / (2 * constants::pi * constants::gas_constant * t));
}

struct Row {
  double above_boiling;             // T - T_b [K]
  double recoil_kpa, recoil_digit;  // 0.54 p_sat and half a unit of its last digit
  double flux, flux_digit;          // [kg/(m^2 s)]
  double heat, heat_digit;          // [W/m^2]
};

void check_rows(const char* name, std::initializer_list<Row> rows) {
  const Material m = material_by_name(name);
  for (const Row& row : rows) {
    CAPTURE(name, row.above_boiling);
    const double t = m.boiling_temperature + row.above_boiling;
    CHECK(0.54e-3 * m.saturation_pressure(t) == Approx(row.recoil_kpa).margin(row.recoil_digit).epsilon(0));
    CHECK(mass_flux(m, t) == Approx(row.flux).margin(row.flux_digit).epsilon(0));
    const double heat = mass_flux(m, t) * m.latent_heat_vaporisation;
    CHECK(heat == Approx(row.heat).margin(row.heat_digit).epsilon(0));
  }
}

}  // namespace

TEST_CASE("the saturation pressure is one atmosphere at the boiling temperature") {
  for (const auto& name : material_names()) {
    CAPTURE(name);
    const Material m = material_by_name(name);
    CHECK(m.saturation_pressure(m.boiling_temperature) == Approx(101325).epsilon(1e-14));
    CHECK(0.54 * m.saturation_pressure(m.boiling_temperature) == Approx(54.7e3).margin(50).epsilon(0));
    CHECK(m.saturation_pressure(300) < 1e-10);
    CHECK(m.saturation_pressure(0) == 0);
    CHECK(m.saturation_pressure_slope(0) == 0);
  }
}

TEST_CASE("the vapour-pressure constant L_v M / R") {
  const auto theta = [](const Material& m) {
    return m.latent_heat_vaporisation * m.molar_mass / constants::gas_constant;
  };
  CHECK(theta(material_by_name("iron")) == Approx(40904).margin(0.5).epsilon(0));
  CHECK(theta(material_by_name("aluminium")) == Approx(34074).margin(0.5).epsilon(0));
}

TEST_CASE("recoil pressure, mass flux and heat loss around the boiling temperature") {
  check_rows("iron", {{-200, 22.5, 0.05, 20.6, 0.05, 1.25e8, 0.5e6},
                      {0, 54.7, 0.05, 48.5, 0.05, 2.96e8, 0.5e6},
                      {200, 119.7, 0.05, 102.9, 0.05, 6.27e8, 0.5e6},
                      {400, 239.7, 0.05, 200.2, 0.05, 1.22e9, 0.5e7},
                      {600, 445.6, 0.05, 362.0, 0.05, 2.20e9, 0.5e7}});
  check_rows("aluminium", {{-200, 21.3, 0.05, 14.5, 0.05, 1.52e8, 0.5e6},
                           {0, 54.7, 0.05, 35.7, 0.05, 3.75e8, 0.5e6},
                           {200, 123.7, 0.05, 78.0, 0.05, 8.20e8, 0.5e6},
                           {400, 252.5, 0.05, 154.2, 0.05, 1.62e9, 0.5e7},
                           {600, 473.9, 0.05, 280.8, 0.05, 2.95e9, 0.5e7}});
}

TEST_CASE("the slope of the saturation pressure agrees with finite differences") {
  for (const auto& name : material_names()) {
    CAPTURE(name);
    const Material m = material_by_name(name);
    for (const double t : {1500.0, 2800.0, 3500.0, 5000.0}) {
      const double step = 0.01;
      const double slope = (m.saturation_pressure(t + step) - m.saturation_pressure(t - step)) / (2 * step);
      // Truncation (theta/T^2)^2 step^2 / 6 < 1e-8, round-off about 1e-16 / (step theta / T^2) < 1e-11.
      CHECK(m.saturation_pressure_slope(t) == Approx(slope).epsilon(1e-7));
    }
  }
}
