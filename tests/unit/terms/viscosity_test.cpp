// SPDX-License-Identifier: MIT
#include "meltray/terms/viscosity.hpp"

#include <catch2/catch.hpp>

#include "unit/terms/stage_setup.hpp"
#include "unit/terms/viscous_checks.hpp"

using namespace meltray;
using meltray::test::Noise;
using meltray::test::StageSetup;
using terms::ViscousOperator;

namespace {

constexpr double kDx = 5e-5, kNu = 5e-3 / 7000;

ViscousOperator physical(const StageSetup& s) {
  ViscousOperator op;
  op.assemble(s.stage, {true, false}, {});
  return op;
}

}  // namespace

TEST_CASE("viscosity: a shear wave decays at the rate nu k^2") {
  for (auto kernel : {sph::KernelType::wendland_c2, sph::KernelType::cubic_spline})
    for (int dim : {2, 3}) {
      CAPTURE(dim, static_cast<int>(kernel));
      StageSetup s(dim, kDx, test::plain_metal(), kernel);
      const Vec3 max(9 * kDx, 40 * kDx, dim == 3 ? 9 * kDx : 0.0);
      s.fill(Vec3::Zero(), max, 2000);
      s.prepare(Vec3::Zero(), max, {true, true, dim == 3});
      const double k = 2 * M_PI / max[1];
      s.set_velocity([&](const Vec3& x) { return Vec3(std::sin(k * x[1]), 0, 0); });
      const auto a = test::acceleration(s, physical(s));
      double worst = 0;
      for (Index i = 0; i < s.patch.size(); ++i) {
        worst = std::max(worst, std::abs(a[0][i] + kNu * k * k * s.patch.v[0][i]));
        worst = std::max(worst, std::abs(a[1][i]));
      }
      CHECK(worst < 0.01 * kNu * k * k);
    }
}

TEST_CASE("viscosity: momentum is conserved, the operator symmetric and dissipative, also where mu varies") {
  auto metal = test::plain_metal();
  metal.viscosity = andrade(-3.7, 2700, 1800, 2500);
  StageSetup s(3, kDx, metal);
  test::fill_jittered_block(s, 8);
  Noise noise(2);
  s.set_temperature([&](const Vec3&) { return 2100 + 250 * noise(); });
  const auto op = physical(s);
  test::check_conservation_and_symmetry(s, op);
  // Shear between layers of rotation is resisted: only translation is free of force.
  s.set_velocity([](const Vec3&) { return Vec3(3, -2, 1); });
  CHECK(test::largest(test::acceleration(s, op)) < 1e-9 * kNu / (kDx * kDx));
}

TEST_CASE(
    "viscosity: Couette flow between no-slip walls is linear, at rest and as the limit of a long step") {
  for (int dim : {2, 3}) {
    CAPTURE(dim);
    StageSetup s(dim, kDx);
    const int up = dim - 1, low = 4, high = 5;
    Vec3 max = Vec3::Constant(10 * kDx);
    if (dim == 2) max[2] = 0;
    s.fill(Vec3::Zero(), max, 2000);
    s.dummies(low, Vec3::Zero(), max, 300);
    s.dummies(high, Vec3::Zero(), max, 300);
    s.constants.any_no_slip = true;
    Vec3 reach = Vec3::Zero();
    reach[up] = 3 * kDx;
    s.prepare(-reach, max + reach, {true, dim == 3, false});
    const double speed = 2;
    const auto profile = [&](const Vec3& x) { return speed * x[up] / max[up]; };
    const auto wall = [&](Index i) { return s.patch.wall[i] == high + 1 ? speed : 0.0; };
    for (Index i = 0; i < s.patch.size(); ++i)
      s.patch.v[0][i] = s.patch.wall[i] ? wall(i) : profile(s.position(i));
    auto op = physical(s);
    CHECK(test::largest(test::acceleration(s, op)) < 1e-9 * speed * kNu / (kDx * kDx));

    // From rest: x = (1 - gamma A)^-1 gamma A v tends to the steady change as gamma grows.
    for (Index i = 0; i < s.patch.size(); ++i) s.patch.v[0][i] = wall(i);
    const double gamma = 1e6 * max[up] * max[up] / kNu;
    auto b = test::acceleration(s, op);
    for (int c = 0; c < dim; ++c)
      for (double& v : b[c]) v *= gamma;
    auto x = s.zeros();
    CHECK(op.solve(s.stage, gamma, view(std::as_const(b)), view(x), 1e-10, 2000).converged);
    double worst = 0;
    for (Index i : s.stage.moving) worst = std::max(worst, std::abs(x[0][i] - profile(s.position(i))));
    CHECK(worst < 1e-4 * speed);
  }
}

TEST_CASE("viscosity: a slip wall does not pull, a solid holds the melt") {
  StageSetup s(3, kDx);
  const Vec3 max = Vec3::Constant(9 * kDx);
  s.fill(Vec3::Zero(), max, 2000);
  s.dummies(4, Vec3::Zero(), max, 300);
  s.constants.faces[4].no_slip = false;
  s.prepare(Vec3(0, 0, -3 * kDx), max, {true, true, false});
  for (Index i = 0; i < s.patch.size(); ++i) s.patch.v[0][i] = s.patch.wall[i] ? 0.0 : 1.0;
  CHECK(test::largest(test::acceleration(s, physical(s))) < 1e-9 * kNu / (kDx * kDx));
  // Melt in the ramp above its melting point, where the interface viscosity of solids is at work.
  s.set_temperature([](const Vec3&) { return 1815.0; });
  ViscousOperator interface;
  interface.assemble(s.stage, {false, true}, {1, 1, 50, 50});
  CHECK(test::largest(test::acceleration(s, interface)) < 1e-9 * kNu / (kDx * kDx));
  s.constants.faces[4].no_slip = true;
  interface.assemble(s.stage, {false, true}, {1, 1, 50, 50});
  CHECK(test::largest(test::acceleration(s, interface)) > kNu / (kDx * kDx));
  s.set_temperature([](const Vec3&) { return 2000.0; });

  // Solid below z = 3 dx at rest, the melt over it in motion.
  for (Index i = 0; i < s.patch.size(); ++i)
    if (s.patch.x[2][i] < 3 * kDx) s.patch.liquid[i] = 0;
  terms::prepare_stage(s.stage);
  s.update();
  for (Index i = 0; i < s.patch.size(); ++i) s.patch.v[0][i] = s.patch.liquid[i] ? 1.0 : 0.0;
  const auto a = test::acceleration(s, physical(s));
  int wrong = 0;
  for (Index i : s.stage.moving) {
    const double depth = s.patch.x[2][i] / kDx - 3;
    wrong += depth < 2 ? !(a[0][i] < 0) : a[0][i] > 1e-9;
  }
  CHECK(wrong == 0);
}

// With the solid's particles as points where the velocity vanishes, half a spacing behind the face, melt
// between its own solid flowed by 11 % too fast at 20 across.
TEST_CASE("viscosity: melt shears linearly down to the face of its own solid, which rests or moves") {
  for (auto kernel : {sph::KernelType::wendland_c2, sph::KernelType::cubic_spline})
    for (int dim : {2, 3})
      for (double wall_speed : {0.0, 2.0}) {
        CAPTURE(static_cast<int>(kernel), dim, wall_speed);
        StageSetup s(dim, kDx, test::plain_metal(), kernel);
        const int up = dim - 1;
        Vec3 max = Vec3::Constant(12 * kDx);
        if (dim == 2) max[2] = 0;
        const double face = 5 * kDx;
        s.for_lattice(Vec3::Zero(), max,
                      [&](const Vec3& x) { s.add(x, x[up] < face ? 1000 : 2000, x[up] > face); });
        s.prepare(Vec3::Zero(), max, {true, dim == 3, false});
        const double rate = 1 / kDx;
        s.set_velocity([&](const Vec3& x) {
          return Vec3(wall_speed + (x[up] > face ? rate * (x[up] - face) : 0.0), 0, 0);
        });
        const auto a = test::acceleration(s, physical(s));
        double worst = 0;
        for (Index i : s.stage.moving)
          if (s.patch.x[up][i] < 9 * kDx) worst = std::max(worst, std::abs(a[0][i]));
        CHECK(worst < 1e-2 * kNu * rate / kDx);
      }
}

TEST_CASE("viscosity: the implicit solve is that of the dense matrix") {
  StageSetup s(3, kDx);
  test::fill_jittered_block(s, 5);
  const auto op = physical(s);
  test::check_solve_against_dense(s, op, 50 / op.rate(s.stage));
}
