// SPDX-License-Identifier: MIT
#include "meltray/terms/evaporation.hpp"

#include <catch2/catch.hpp>

#include "meltray/core/constants.hpp"
#include "unit/terms/stage_setup.hpp"

using namespace meltray;
using meltray::test::StageSetup;
using terms::SurfaceLosses;

namespace {

constexpr double kDx = 5e-5;

/// A layer with one free face of 12 x 12 spacings; the lower face stands on dummies.
void layer(StageSetup& s, double temperature) {
  const Vec3 max = Vec3::Constant(12 * kDx);
  s.fill(Vec3::Zero(), max, temperature, temperature > 1810);
  s.dummies(4, Vec3::Zero(), max, 300);
  s.prepare(Vec3(0, 0, -3 * kDx), max + Vec3(0, 0, 4 * kDx), {true, true, false});
}

}  // namespace

TEST_CASE("evaporation: mass and heat flux of iron and aluminium around the boiling point") {
  // 0.82 p_sat sqrt(M / (2 pi R T)) and L_v times it.
  const Material iron = material_by_name("iron"), aluminium = material_by_name("aluminium");
  const SurfaceLosses losses{true, false, 0.82, 300};
  const double fe[] = {20.6, 48.5, 102.9, 200.2, 362.0}, al[] = {14.5, 35.7, 78.0, 154.2, 280.8};
  for (int k = 0; k < 5; ++k) {
    const double dt = 200.0 * (k - 1);
    CHECK(losses.mass_flux(iron, iron.boiling_temperature + dt) == Approx(fe[k]).epsilon(0.004));
    CHECK(losses.mass_flux(aluminium, aluminium.boiling_temperature + dt) == Approx(al[k]).epsilon(0.004));
  }
  CHECK(losses.mass_flux(iron, iron.boiling_temperature) * iron.latent_heat_vaporisation ==
        Approx(2.96e8).epsilon(0.003));
}

TEST_CASE("evaporation: the slope is the derivative of the flux") {
  const Material iron = material_by_name("iron");
  const SurfaceLosses losses{true, false, 0.82, 300};
  for (double t : {1900.0, 2500.0, 3134.0, 4000.0, 5000.0}) {
    const double d = 0.01;
    CHECK((losses.mass_flux(iron, t + d) - losses.mass_flux(iron, t - d)) / (2 * d) ==
          Approx(losses.mass_flux_slope(iron, t)).epsilon(1e-6));
  }
}

TEST_CASE("evaporation: a flat liquid face loses area times flux, and the crossings say so") {
  StageSetup s(3, kDx);
  layer(s, 3300);
  const Material& m = s.constants.material;
  const SurfaceLosses losses{true, true, 0.82, 400};
  std::vector<double> heating(s.patch.size(), 0.0);
  terms::Crossings crossings;
  losses.add_heating(s.stage, heating.data(), crossings);
  const double area = std::pow(12 * kDx, 2);
  const double p_sat = 101325 * std::exp(6e6 * 0.056 / constants::gas_constant * (1 / 3100.0 - 1 / 3300.0));
  const double flux = 0.82 * p_sat * std::sqrt(0.056 / (2 * M_PI * constants::gas_constant * 3300));
  CHECK(crossings.evaporated_mass == Approx(area * flux));
  CHECK(crossings.evaporation == Approx(area * flux * 6e6));
  CHECK(crossings.radiation ==
        Approx(area * 0.5 * constants::stefan_boltzmann * (std::pow(3300, 4) - std::pow(400, 4))));
  double lost = 0, inside = 0;
  for (Index i = 0; i < s.patch.size(); ++i) {
    lost -= s.patch.mass[i] * heating[i];
    if (s.patch.x[2][i] < 11 * kDx) inside += std::abs(heating[i]);
  }
  CHECK(lost == Approx(crossings.evaporation + crossings.radiation));
  CHECK(inside == 0);

  // The slopes are those of the crossings.
  std::vector<double> slope(s.patch.size());
  losses.slope(s.stage, slope.data());
  double sum = 0, fastest = 0;
  for (Index i = 0; i < s.patch.size(); ++i) {
    sum += slope[i];
    fastest = std::max(fastest, -slope[i] / s.patch.mass[i] / m.heat_capacity_liquid);
  }
  const auto total = [&](double t) {
    s.set_temperature([&](const Vec3&) { return t; });
    std::vector<double> h(s.patch.size(), 0.0);
    terms::Crossings p;
    losses.add_heating(s.stage, h.data(), p);
    return p.evaporation + p.radiation;
  };
  CHECK(sum == Approx(-(total(3300.01) - total(3299.99)) / 0.02).epsilon(1e-6));
  s.set_temperature([](const Vec3&) { return 3300.0; });
  CHECK(losses.rate(s.stage) == Approx(fastest));
}

TEST_CASE("evaporation: at a face light, losses and conduction over half a layer balance") {
  StageSetup s(3, kDx);
  layer(s, 3300);
  const SurfaceLosses losses{true, true, 0.82, 300, true};
  const double conductance = 35 / (0.5 * kDx);
  for (const double flux : {0.0, 1e8, 1e9, 1e10, 1e13}) {
    std::vector<double> light(s.patch.size());
    for (Index i = 0; i < s.patch.size(); ++i) light[i] = flux * s.stage.area[i];
    losses.find_faces(s.stage, light);
    double coldest = 1e9, hottest = 0;
    for (Index i = 0; i < s.patch.size(); ++i) {
      const double t = s.stage.face_temperature[i];
      CHECK(s.stage.surface_temperature(i) == t);
      if (s.stage.area[i] == 0) {
        CHECK(t == s.stage.temperature[i]);
        continue;
      }
      const double p_sat = 101325 * std::exp(6e6 * 0.056 / constants::gas_constant * (1 / 3100.0 - 1 / t));
      const double lost = 0.82 * p_sat * std::sqrt(0.056 / (2 * M_PI * constants::gas_constant * t)) * 6e6 +
                          0.5 * constants::stefan_boltzmann * (std::pow(t, 4) - std::pow(300.0, 4));
      // Face and dummies are flat: the layer is one spacing thick.
      CHECK(flux - lost == Approx(conductance * (t - 3300)).margin(1e-5 * (flux + lost)));
      coldest = std::min(coldest, t);
      hottest = std::max(hottest, t);
    }
    CHECK((flux < 1e9 ? hottest < 3300 : coldest > 3300));
  }
  // In the dark the loss is that of the faces, not of the particles.
  losses.find_faces(s.stage, {});
  std::vector<double> heating(s.patch.size(), 0.0);
  terms::Crossings at_faces, at_particles;
  losses.add_heating(s.stage, heating.data(), at_faces);
  s.stage.face_temperature.clear();
  losses.add_heating(s.stage, heating.data(), at_particles);
  CHECK(at_faces.evaporation < 0.7 * at_particles.evaporation);
}

TEST_CASE("evaporation: the slope of the losses at a face is that over the temperature of its particle") {
  StageSetup s(3, kDx);
  layer(s, 3300);
  const Material& m = s.constants.material;
  const SurfaceLosses losses{true, true, 0.82, 300, true};
  std::vector<double> light(s.patch.size()), slope(s.patch.size());
  for (Index i = 0; i < s.patch.size(); ++i) light[i] = 2e9 * s.stage.area[i];
  losses.find_faces(s.stage, light);
  losses.slope(s.stage, slope.data());
  double sum = 0, fastest = 0;
  for (Index i = 0; i < s.patch.size(); ++i) {
    sum += slope[i];
    fastest = std::max(fastest, -slope[i] / s.patch.mass[i] / m.heat_capacity_liquid);
  }
  CHECK(losses.rate(s.stage) == Approx(fastest));
  const auto total = [&](double t) {
    s.set_temperature([&](const Vec3&) { return t; });
    losses.find_faces(s.stage, light);
    std::vector<double> h(s.patch.size(), 0.0);
    terms::Crossings p;
    losses.add_heating(s.stage, h.data(), p);
    return p.evaporation + p.radiation;
  };
  CHECK(sum == Approx(-(total(3300.5) - total(3299.5))).epsilon(1e-4));
}

TEST_CASE("evaporation: solid only radiates, and a term that is off does nothing") {
  StageSetup s(3, kDx);
  layer(s, 1700);
  std::vector<double> heating(s.patch.size(), 0.0);
  terms::Crossings crossings;
  SurfaceLosses{true, true, 0.82, 300}.add_heating(s.stage, heating.data(), crossings);
  CHECK(crossings.evaporation == 0);
  CHECK(crossings.evaporated_mass == 0);
  CHECK(crossings.radiation > 0);
  crossings = {};
  SurfaceLosses{true, false, 0.82, 300}.add_heating(s.stage, heating.data(), crossings);
  CHECK(crossings.radiation == 0);
}

TEST_CASE("evaporation: linearly implicit steps cool monotonously where explicit ones overshoot") {
  StageSetup s(3, kDx);
  layer(s, 4500);
  const SurfaceLosses losses{true, true, 0.82, 300};
  const Material& m = s.constants.material;
  Index i = 0;
  while (s.stage.surface[i] < 1) ++i;
  const double dt = 30 / losses.rate(s.stage);
  std::vector<double> heating(s.patch.size(), 0.0), slope(s.patch.size());
  terms::Crossings crossings;
  losses.add_heating(s.stage, heating.data(), crossings);
  CHECK(m.temperature(s.patch.h[i] + dt * heating[i]) < 300);  // explicit Euler
  double last = 4500;
  for (int k = 0; k < 50; ++k) {
    std::fill(heating.begin(), heating.end(), 0.0);
    losses.add_heating(s.stage, heating.data(), crossings);
    losses.slope(s.stage, slope.data());
    const double j = slope[i] / s.patch.mass[i] * m.temperature_slope(s.patch.h[i]);
    s.patch.h[i] += dt * heating[i] / (1 - dt * j);
    s.update();
    CHECK(s.stage.temperature[i] < last);
    CHECK(s.stage.temperature[i] > 1810);
    last = s.stage.temperature[i];
  }
}
