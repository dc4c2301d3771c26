// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "meltray/core/constants.hpp"
#include "meltray/terms/pressure/projection.hpp"
#include "meltray/terms/surface_forces.hpp"
#include "unit/terms/stage_setup.hpp"

using namespace meltray;
using meltray::test::StageSetup;
using terms::Recoil;
using terms::RecoilOnset;

namespace {

constexpr double kDx = 5e-5, kSlope = 1e8;  // of the pressure along the slab [Pa/m]
constexpr int kLayers = 4;

/// A slab of melt with an open face below and above, 16 spacings long; its layers lie across the last axis.
void fill_slab(StageSetup& s, double jitter = 0) {
  Vec3 max = Vec3::Constant(16 * kDx), above = max;
  const int across = s.constants.dim - 1;
  max[across] = kLayers * kDx;
  above[across] = 12 * kDx;
  Vec3 below = Vec3::Zero();
  below[across] = -8 * kDx;
  s.fill(Vec3::Zero(), max, 2000);
  s.jitter(jitter);
  s.prepare(below, above);
}

/// Acceleration along the slab over -slope / rho, the mean and the largest distance from it in each layer,
/// away from the ends; and the largest across.
struct Layers {
  std::array<double, kLayers> mean{}, spread{};
  double across = 0;
};

Layers along(const StageSetup& s, const Components& a) {
  const int across = s.constants.dim - 1;
  const double unit = -kSlope / s.constants.density;
  std::array<std::vector<double>, kLayers> of_layer;
  Layers layers;
  for (Index i = 0; i < s.patch.size(); ++i) {
    const Vec3 x = s.position(i) / kDx;
    if (x[0] < 5 || x[0] > 11 || (s.constants.dim == 3 && (x[1] < 5 || x[1] > 11))) continue;
    of_layer[static_cast<std::size_t>(std::clamp(x[across], 0.0, kLayers - 0.01))].push_back(a[0][i] / unit);
    layers.across = std::max(layers.across, std::abs(a[across][i] / unit));
  }
  for (int k = 0; k < kLayers; ++k) {
    for (const double value : of_layer[k]) layers.mean[k] += value / of_layer[k].size();
    for (const double value : of_layer[k])
      layers.spread[k] = std::max(layers.spread[k], std::abs(value - layers.mean[k]));
  }
  return layers;
}

void press(StageSetup& s, double slope) {
  for (Index i = 0; i < s.patch.size(); ++i) s.stage.surface_pressure[i] = 5e4 + slope * s.position(i)[0];
}

}  // namespace

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
  CHECK(r.pressure(iron, 3500, 5e-3, 1e-8) == 2e4);
  r.prescribed_radius = 1e-4;
  CHECK(r.pressure(iron, 3500, 5e-3) == 2e4);
  CHECK(r.pressure(iron, 3500, 5e-3, 1e-8) == Approx(2e4 * std::exp(-2.0)));
}

TEST_CASE("recoil: its slope moves the outermost layer of a slab as it moves those below") {
  const int dim = GENERATE(2, 3);
  StageSetup s(dim, kDx);
  fill_slab(s);
  press(s, kSlope);
  terms::Projection projection;
  projection.assemble(s.stage);
  s.patch.pressure = s.stage.surface_pressure;
  Components a = s.zeros();
  projection.add_acceleration(s.stage, terms::SurfaceEntry::csf, view(a));
  const Layers inside = along(s, a);
  terms::add_recoil_along_surface(s.stage, s.stage.surface_pressure, view(a));
  const Layers whole = along(s, a);
  CAPTURE(dim, inside.mean[0], whole.mean[0], whole.mean[1]);
  CHECK(inside.mean[0] == Approx(s.constants.lattice.face_moment));  // without: a fifth is missing
  CHECK(inside.mean[0] < 0.8);
  for (int k = 0; k < kLayers; ++k) CHECK(whole.mean[k] == Approx(1).margin(0.01));
  CHECK(whole.across < 1e-6);
}

TEST_CASE("recoil: nothing is added inside, nor where it is uniform") {
  const int dim = GENERATE(2, 3);
  StageSetup s(dim, kDx);
  fill_slab(s);
  press(s, kSlope);
  Components a = s.zeros();
  terms::add_recoil_along_surface(s.stage, s.stage.surface_pressure, view(a));
  const Layers sloped = along(s, a);
  CHECK(sloped.mean[0] == Approx(1 - s.constants.lattice.face_moment).epsilon(0.01));
  CHECK(std::abs(sloped.mean[1]) < 0.01);
  press(s, 0);
  Components b = s.zeros();
  terms::add_recoil_along_surface(s.stage, s.stage.surface_pressure, view(b));
  for (int c = 0; c < dim; ++c)
    for (const double value : b[c]) CHECK(value == 0);
}

TEST_CASE("recoil: its slope is exact over disordered particles, but for how much of a face they are") {
  const int dim = GENERATE(2, 3);
  StageSetup s(dim, kDx);
  fill_slab(s, 0.1);
  press(s, kSlope);
  Components a = s.zeros();
  terms::add_recoil_along_surface(s.stage, s.stage.surface_pressure, view(a));
  const Layers layers = along(s, a);
  const double missing = 1 - s.constants.lattice.face_moment;
  CAPTURE(dim, layers.mean[0] / missing, layers.spread[0] / missing);
  CHECK(layers.mean[0] == Approx(missing).epsilon(0.1));
  CHECK(layers.spread[0] < 0.3 * missing);
}
