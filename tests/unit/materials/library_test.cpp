// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <string>

#include "meltray/core/constants.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/core/nearest.hpp"
#include "meltray/materials/material.hpp"

using namespace meltray;

namespace {

double normal_absorptance(std::complex<double> index) {  // A = 4n / ((n + 1)^2 + k^2)
  const double n = index.real(), k = index.imag();
  return 4 * n / ((n + 1) * (n + 1) + k * k);
}

}  // namespace

TEST_CASE("an unknown material is answered with the nearest name and the list") {
  const auto message = [](const char* name) {
    try {
      material_by_name(name);
    } catch (const UsageError& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  CHECK(
      message("irn") ==
      "unknown material \"irn\": nearest is \"iron\"; known materials: iron, aluminium, ss316, ti64, al6061");
  CHECK_THAT(message("aluminum"), Catch::Contains("nearest is \"aluminium\""));
  CHECK_THAT(message("316"), Catch::Contains("nearest is \"ss316\""));
  CHECK_THAT(message(""), Catch::Contains("unknown material \"\""));
  CHECK_THROWS_AS(material_summary("unobtainium"), UsageError);
}

TEST_CASE("edit distances") {
  CHECK(edit_distance("", "iron") == 4);
  CHECK(edit_distance("iron", "iron") == 0);
  CHECK(edit_distance("kitten", "sitting") == 3);
  CHECK(nearest_name("x", {}).empty());
}

TEST_CASE("every built-in material is complete and physically possible") {
  for (const auto& name : material_names()) {
    CAPTURE(name);
    const Material m = material_by_name(name);
    CHECK(m.name == name);
    CHECK_FALSE(material_summary(name).empty());
    CHECK(m.density > 2000);
    CHECK(m.solidus < m.liquidus);
    CHECK(m.liquidus < m.boiling_temperature);
    CHECK(m.latent_heat_fusion < m.latent_heat_vaporisation);
    CHECK(m.molar_mass > 0.02);
    CHECK(m.viscosity(m.liquidus) > 1e-3);
    CHECK(m.viscosity(m.boiling_temperature) > 0);
    CHECK(m.sigma(m.liquidus) > 0.8);
    CHECK(m.sigma_slope(m.liquidus) < 0);
    CHECK(m.density_of_t(m.liquidus) == Approx(m.density).epsilon(1e-3));
    CHECK(m.emissivity > 0);
    CHECK(m.emissivity < 1);
    CHECK(m.contact_angle_deg == 10);
    CHECK(m.has_index() == (name != "ti64"));
  }
}

TEST_CASE("the surface tension ends at its floor, where it no longer depends on temperature") {
  const Material m = material_by_name("iron");
  CHECK(m.sigma(1811) == Approx(1.87));
  CHECK(m.sigma(2811) == Approx(1.44));
  CHECK(m.sigma_slope(2811) == -4.3e-4);
  const double t_floor = 1811 + 0.9 * 1.87 / 4.3e-4;  // 5725 K
  CHECK(m.sigma(t_floor + 1) == Approx(0.187));
  CHECK(m.sigma(1e5) == Approx(0.187));
  CHECK(m.sigma_slope(t_floor - 1) == -4.3e-4);
  CHECK(m.sigma_slope(t_floor + 1) == 0);
}

TEST_CASE("liquid properties at the melting point and beyond the range of their data") {
  const Material iron = material_by_name("iron"), aluminium = material_by_name("aluminium");
  CHECK(iron.viscosity(1811) == Approx(5.85e-3).margin(5e-6).epsilon(0));
  CHECK(aluminium.viscosity(933.47) == Approx(1.34e-3).margin(5e-6).epsilon(0));
  CHECK(iron.viscosity(3134) == iron.viscosity(2500));
  CHECK(iron.viscosity(300) == iron.viscosity(1811));
  CHECK(iron.viscosity.slope(3000) == 0);
  CHECK(iron.density_of_t(3134) == Approx(7034.96 - 0.926 * 1323));
  CHECK(iron.density_of_t(4000) == iron.density_of_t(3134));
  CHECK(iron.density_of_t(300) == Approx(7034.96));
  // The expansion coefficient of Eq. (8) is the slope of the density at its reference temperature.
  for (const Material& m : {iron, aluminium}) {
    CAPTURE(m.name);
    const double beta = -m.density_of_t.slope(m.expansion_reference) / m.density;
    CHECK(m.expansion == Approx(beta).epsilon(5e-3));  // three digits are given
  }
}

TEST_CASE("optical constants: absorptance at normal incidence") {
  CHECK(normal_absorptance(material_by_name("iron").index_liquid) == Approx(0.339).margin(5e-4).epsilon(0));
  CHECK(normal_absorptance(material_by_name("aluminium").index_solid) ==
        Approx(0.054).margin(5e-4).epsilon(0));
  CHECK(normal_absorptance(material_by_name("aluminium").index_liquid) ==
        Approx(0.088).margin(5e-4).epsilon(0));
}

TEST_CASE("the index of liquid aluminium is that of a free-electron metal") {
  // Drude: eps = 1 - w_p^2 / (w^2 + i w / tau), three electrons an atom, resistivity 0.24 uOhm m, 1.07 um.
  constexpr double charge = 1.602176634e-19, mass = 9.1093837015e-31, eps0 = 8.8541878128e-12;
  constexpr double avogadro = 6.02214076e23, light = 299792458.0, resistivity = 0.24e-6, lambda = 1.07e-6;
  const Material m = material_by_name("aluminium");
  const double n_e = 3 * m.density / m.molar_mass * avogadro;
  const double plasma2 = n_e * charge * charge / (eps0 * mass);
  const double tau = mass / (n_e * charge * charge * resistivity);
  const double omega = 2 * constants::pi * light / lambda;
  const std::complex<double> eps = 1.0 - plasma2 / std::complex<double>(omega * omega, omega / tau);
  const std::complex<double> index = std::sqrt(eps);
  CHECK(m.index_liquid.real() == Approx(index.real()).margin(5e-3).epsilon(0));
  CHECK(m.index_liquid.imag() == Approx(index.imag()).margin(5e-3).epsilon(0));
}
