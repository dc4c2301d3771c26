// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "meltray/core/constants.hpp"
#include "meltray/terms/surface_forces.hpp"

using namespace meltray;
using terms::Recoil;
using terms::RecoilOnset;

TEST_CASE("recoil: values of iron and aluminium around the boiling point") {
  // 0.54 p_0 exp[(L_v M/R)(1/T_b - 1/T)] with L_v M/R = 40,904 K (iron), 34,074 K (aluminium).
  const Material iron = material_by_name("iron"), aluminium = material_by_name("aluminium");
  const Recoil r;
  CHECK(r.pressure(iron, iron.boiling_temperature, 0) == Approx(0.54 * 101325));
  const double fe[] = {22.5e3, 54.7e3, 119.7e3, 239.7e3, 445.6e3};
  const double al[] = {21.3e3, 54.7e3, 123.7e3, 252.5e3, 473.9e3};
  for (int k = 0; k < 5; ++k) {
    const double dt = 200.0 * (k - 1);
    CHECK(r.pressure(iron, iron.boiling_temperature + dt, 0) == Approx(fe[k]).epsilon(0.003));
    CHECK(r.pressure(aluminium, aluminium.boiling_temperature + dt, 0) == Approx(al[k]).epsilon(0.003));
  }
}

TEST_CASE("recoil: onset variants") {
  const Material iron = material_by_name("iron");
  const double tb = iron.boiling_temperature;
  Recoil smooth, cutoff, ambient;
  cutoff.onset = RecoilOnset::cutoff;
  ambient.onset = RecoilOnset::ambient;
  CHECK(cutoff.pressure(iron, tb - 1e-6, 0) == 0);
  CHECK(cutoff.pressure(iron, tb, 0) == Approx(0.54 * constants::standard_atmosphere));
  // C_r p_sat reaches p_0 where p_sat = p_0 / 0.54: T = 1 / (1/T_b + ln(0.54) R/(L_v M)).
  const double theta = iron.latent_heat_vaporisation * iron.molar_mass / constants::gas_constant;
  const double onset = 1 / (1 / tb + std::log(0.54) / theta);
  CHECK(ambient.pressure(iron, onset - 0.01, 0) == 0);
  CHECK(ambient.pressure(iron, onset + 0.01, 0) > 0);
  CHECK(ambient.pressure(iron, 3800, 0) ==
        Approx(smooth.pressure(iron, 3800, 0) - constants::standard_atmosphere));
  CHECK(smooth.pressure(iron, tb - 200, 0) > 0);
}

TEST_CASE("recoil: a prescribed pressure replaces the vapour and starts on a ramp") {
  const Material iron = material_by_name("iron");
  Recoil r;
  r.prescribed = 2e4;
  CHECK(r.pressure(iron, 300, 0) == 2e4);
  r.prescribed_ramp = 1e-3;
  CHECK(r.pressure(iron, 3500, 0) == 0);
  CHECK(r.pressure(iron, 3500, 2.5e-4) == Approx(5e3));
  CHECK(r.pressure(iron, 3500, 5e-3) == 2e4);
}
