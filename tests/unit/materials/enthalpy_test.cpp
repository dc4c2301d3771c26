// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "meltray/materials/material.hpp"

using namespace meltray;

TEST_CASE("temperature and enthalpy are inverse to each other for every material") {
  for (const auto& name : material_names()) {
    CAPTURE(name);
    const Material m = material_by_name(name);
    for (double t = 1; t < 5000; t += 0.37) {
      CAPTURE(t);
      // Both directions are a few operations on numbers of order h, so a few ulp.
      REQUIRE(m.temperature(m.enthalpy(t)) == Approx(t).epsilon(1e-13));
    }
    for (const double t : {m.solidus, 0.5 * (m.solidus + m.liquidus), m.liquidus, m.boiling_temperature})
      CHECK(m.temperature(m.enthalpy(t)) == Approx(t).epsilon(1e-14));
  }
}

TEST_CASE("enthalpy and temperature grow strictly") {
  for (const auto& name : material_names()) {
    CAPTURE(name);
    const Material m = material_by_name(name);
    double last_h = -std::numeric_limits<double>::infinity(), last_t = last_h;
    for (double t = 1; t < 5000; t += 0.29) {
      const double h = m.enthalpy(t);
      REQUIRE(h > last_h);
      last_h = h;
    }
    for (double h = 0; h < m.enthalpy(5000); h += 997) {
      const double t = m.temperature(h);
      REQUIRE(t > last_t);
      last_t = t;
    }
  }
}

TEST_CASE("melting stores the latent heat and the sensible heat of the band") {
  for (const auto& name : material_names()) {
    CAPTURE(name);
    const Material m = material_by_name(name);
    const double width = m.liquidus - m.solidus;
    CHECK(width == Approx(5));
    const double sensible = 0.5 * (m.heat_capacity_solid + m.heat_capacity_liquid) * width;
    const double stored = m.enthalpy(m.liquidus) - m.enthalpy(m.solidus);
    CHECK(stored == Approx(m.latent_heat_fusion + sensible).epsilon(1e-12));
    CHECK(m.enthalpy(m.solidus) == Approx(m.enthalpy_solidus()).epsilon(1e-15));
    CHECK(m.enthalpy(m.liquidus) == Approx(m.enthalpy_liquidus()).epsilon(1e-15));
    // Heating from T_1 to T_2 across the band, the balance a calorimeter would find.
    const double heated = m.enthalpy(m.liquidus + 100) - m.enthalpy(m.solidus - 100);
    CHECK(heated ==
          Approx(100 * (m.heat_capacity_solid + m.heat_capacity_liquid) + m.latent_heat_fusion + sensible)
              .epsilon(1e-12));
  }
}

TEST_CASE("dT/dh agrees with finite differences in the solid, in the band and in the liquid") {
  for (const auto& name : material_names()) {
    CAPTURE(name);
    const Material m = material_by_name(name);
    for (const double t : {400.0, m.solidus - 1, m.solidus + 1, m.liquidus - 1, m.liquidus + 1, 3500.0}) {
      CAPTURE(t);
      const double h = m.enthalpy(t), step = 10;  // T(h) is piecewise linear: the difference is exact
      const double slope = (m.temperature(h + step) - m.temperature(h - step)) / (2 * step);
      CHECK(m.temperature_slope(h) == Approx(slope).epsilon(1e-9));  // round-off: eps T / dT
    }
  }
}

TEST_CASE("the liquid fraction is 0 up to the solidus, linear in enthalpy, 1 from the liquidus on") {
  const Material m = material_by_name("iron");
  const double h_s = m.enthalpy_solidus(), h_l = m.enthalpy_liquidus();
  CHECK(m.liquid_fraction(0) == 0);
  CHECK(m.liquid_fraction(h_s) == 0);
  CHECK(m.liquid_fraction(h_s + 0.25 * (h_l - h_s)) == Approx(0.25).epsilon(1e-12));
  CHECK(m.liquid_fraction(h_l) == 1);
  CHECK(m.liquid_fraction(2 * h_l) == 1);
}

TEST_CASE("the conductivity goes from solid to liquid across the band without a jump") {
  const Material m = material_by_name("aluminium");
  const double h_s = m.enthalpy_solidus(), h_l = m.enthalpy_liquidus();
  CHECK(m.conductivity(0.5 * h_s) == 220);
  CHECK(m.conductivity(2 * h_l) == 94);
  CHECK(m.conductivity(0.5 * (h_s + h_l)) == Approx(157).epsilon(1e-12));
  CHECK(m.conductivity(h_s + 1e-6) == Approx(220).epsilon(1e-9));
  CHECK(m.conductivity(h_l - 1e-6) == Approx(94).epsilon(1e-9));
}

TEST_CASE("the largest diffusivity is that of the faster phase") {
  const Material iron = material_by_name("iron");
  CHECK(iron.thermal_diffusivity_max() == Approx(34.0 / (7035 * 690)).epsilon(1e-12));
  const Material aluminium = material_by_name("aluminium");
  CHECK(aluminium.thermal_diffusivity_max() == Approx(220.0 / (2377 * 1000)).epsilon(1e-12));
  // Gan 2021 gives the diffusivity of its sets with four digits.
  CHECK(material_by_name("ss316").thermal_diffusivity_max() == Approx(4.949e-6).epsilon(2e-4));
  CHECK(material_by_name("ti64").thermal_diffusivity_max() == Approx(1.027e-5).epsilon(5e-4));
  CHECK(material_by_name("al6061").thermal_diffusivity_max() == Approx(3.185e-5).epsilon(2e-4));
}

TEST_CASE("a conductivity that varies with temperature counts with its largest value") {
  Material m = material_by_name("iron");
  m.conductivity_solid = linear(80, -0.025, 300, 300, 1811);
  CHECK(m.thermal_diffusivity_max() == Approx(80.0 / (7035 * 690)).epsilon(1e-12));
}
