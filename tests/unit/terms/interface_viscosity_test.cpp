// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <limits>

#include "meltray/terms/viscosity.hpp"
#include "unit/terms/stage_setup.hpp"
#include "unit/terms/viscous_checks.hpp"

using namespace meltray;
using meltray::test::Noise;
using meltray::test::StageSetup;
using terms::ViscousOperator;

namespace {

constexpr double kDx = 5e-5;
/// Rounding of what the operator stores.
constexpr double kSingle = std::numeric_limits<float>::epsilon();
const terms::InterfaceViscosityParameters kBoth{0.7, 1.0, 50, 50};

ViscousOperator interface(const StageSetup& s, terms::InterfaceViscosityParameters p = kBoth) {
  ViscousOperator op;
  op.assemble(s.stage, {false, true}, p);
  return op;
}

}  // namespace

TEST_CASE("interface viscosity: conserves momentum, is symmetric and dissipative") {
  StageSetup s(3, kDx);
  test::fill_jittered_block(s, 8);
  Noise noise(6);
  s.set_temperature([&](const Vec3&) { return 1850 + 45 * noise(); });
  test::check_conservation_and_symmetry(s, interface(s));
}

TEST_CASE("interface viscosity: rigid motion is free of force") {
  StageSetup s(3, kDx);
  test::fill_jittered_block(s, 8);
  s.set_temperature([](const Vec3&) { return 1820.0; });
  const auto op = interface(s);
  const double scale = op.rate(s.stage);
  s.set_velocity([](const Vec3&) { return Vec3(1, 2, -3); });
  CHECK(test::largest(test::acceleration(s, op)) < 1e-12 * scale);
  const Vec3 omega(500, -300, 800);
  s.set_velocity([&](const Vec3& x) -> Vec3 { return omega.cross(x); });
  // The directions of the pairs are stored in single precision.
  CHECK(test::largest(test::acceleration(s, op)) < kSingle * scale * omega.norm() * 8 * kDx);
}

TEST_CASE("interface viscosity: acts like the kinematic viscosity alpha h c / 8 in 2-D") {
  // Monaghan 2005, sect. 4.2: nu = alpha h c / 8 in 2-D, here at T below melting, where the solid part is
  // full everywhere. A lattice is stiffer along its diagonals than along its axes: the mean of the two shear
  // waves at 0 and 45 degrees is the isotropic value, less what 0.01 h^2 in the denominator takes (2 to 3 %).
  StageSetup s(2, kDx);
  const Vec3 max(40 * kDx, 40 * kDx, 0.0);
  s.fill(Vec3::Zero(), max, 1800);
  s.prepare(Vec3::Zero(), max, {true, true, false});
  const double k = 2 * M_PI / max[1], nu = 1.3 * kDx * 50 / 8;
  const auto rate = [&](const Vec3& wave, const Vec3& along) {
    s.set_velocity([&](const Vec3& x) -> Vec3 { return along * std::sin(wave.dot(x)); });
    const auto a = test::acceleration(s, interface(s, {0, 1, 50, 50}));
    return -test::work(s, a, s.patch.v) / test::work(s, s.patch.v, s.patch.v) / wave.squaredNorm();
  };
  const double aligned = rate(Vec3(0, k, 0), Vec3(1, 0, 0)), diagonal = rate(Vec3(k, k, 0), Vec3(1, -1, 0));
  CAPTURE(aligned / nu, diagonal / nu);
  CHECK(0.5 * (aligned + diagonal) == Approx(nu).epsilon(0.05));
}

TEST_CASE("interface viscosity: only where the surface or melting is, scaled by its coefficients") {
  StageSetup s(3, kDx);
  const Vec3 max(9 * kDx, 9 * kDx, 12 * kDx);
  s.fill(Vec3::Zero(), max, 2500);
  s.prepare(Vec3::Zero(), max + Vec3(0, 0, 4 * kDx), {true, true, false});
  s.patch.v = test::random_field(s, 5);
  // Hot: free surface only.
  const auto hot = test::acceleration(s, interface(s));
  const auto half = test::acceleration(s, interface(s, {0.35, 1, 50, 50}));
  const double rate = interface(s).rate(s.stage);
  int wrong = 0;
  for (Index i = 0; i < s.patch.size(); ++i) {
    const double z = s.patch.x[2][i] / kDx;
    const double size = std::abs(hot[0][i]) + std::abs(hot[1][i]) + std::abs(hot[2][i]);
    const bool near = z > 9 || z < 3;  // within 2.6 dx of a surface layer
    wrong += near ? size == 0 : size != 0;
    wrong += std::abs(half[1][i] - 0.5 * hot[1][i]) > kSingle * rate;  // velocities are at most 1 m/s
  }
  CHECK(wrong == 0);
  // The solid part fades out linearly over the ramp above the melting temperature.
  const auto solid_part = [&](double t) {
    s.set_temperature([&](const Vec3&) { return t; });
    return test::acceleration(s, interface(s, {0, 1, 50, 50}))[0][300];
  };
  const double full = solid_part(1810);
  CHECK(full != 0);
  CHECK(solid_part(1700) == Approx(full));
  CHECK(solid_part(1835) == Approx(0.5 * full));
  CHECK(solid_part(1860) == Approx(0).margin(1e-12 * std::abs(full)));
}

TEST_CASE("interface viscosity: the solid drags only melt within the ramp, by the melt's own coefficient") {
  StageSetup s(3, kDx);
  // Melt on solid, inside: periodic all round, so that there is no free surface.
  const Vec3 max(9 * kDx, 9 * kDx, 12 * kDx);
  s.fill(Vec3::Zero(), Vec3(9 * kDx, 9 * kDx, 6 * kDx), 1700, false);
  s.fill(Vec3(0, 0, 6 * kDx), max, 1810);
  s.prepare(Vec3::Zero(), max, {true, true, true});
  s.set_velocity([&](const Vec3& x) { return Vec3(x[2] > 6 * kDx ? 1.0 : 0.0, 0, 0); });
  const auto drag_at = [&](double t) {
    s.set_temperature([&](const Vec3& x) { return x[2] > 6 * kDx ? t : 1700; });
    return test::largest(test::acceleration(s, interface(s, {1, 1, 50, 50})));
  };
  const double full = drag_at(1810);
  CHECK(full > 0);
  CHECK(drag_at(1835) == Approx(0.5 * full));
  CHECK(drag_at(1861) == 0);
}

TEST_CASE(
    "interface viscosity: the implicit solve is that of the dense matrix, also with physical viscosity") {
  StageSetup s(3, kDx);
  test::fill_jittered_block(s, 5);
  s.set_temperature([](const Vec3& x) { return 1820 + 2e5 * x[0]; });
  for (bool physical : {false, true}) {
    ViscousOperator op;
    op.assemble(s.stage, {physical, true}, kBoth);
    test::check_solve_against_dense(s, op, 50 / op.rate(s.stage));
  }
}
