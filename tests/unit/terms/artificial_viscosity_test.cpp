// SPDX-License-Identifier: MIT
#include "meltray/terms/pressure/acoustic_pass.hpp"

#include <catch2/catch.hpp>

#include "unit/terms/stage_setup.hpp"

using namespace meltray;
using namespace meltray::terms;
using meltray::test::StageSetup;

namespace {

constexpr double kAlpha = 0.3, kSound = 40;

struct Liquid : StageSetup {
  explicit Liquid(int dim) : StageSetup(dim, 0.1) {}
  void ready() {
    particles.density.assign(particles.size(), constants.density);
    prepare(Vec3::Constant(-0.6), Vec3::Constant(1.6));
  }
  Components acceleration() {
    AcousticPass pass;
    pass.state.sound_speed = kSound;
    pass.artificial.alpha = kAlpha;
    evaluate(pass);
    Components a = zeros();
    std::vector<double> rate(patch.size());
    pass.add_rates(stage, rate.data(), view(a));
    return a;
  }
};

}  // namespace

TEST_CASE("artificial viscosity of a pair, Monaghan 1992: on approach only, along the line of centres") {
  Liquid b(3);
  b.add(Vec3(0, 0, 0), 2000, true);
  b.add(Vec3(0.1, 0, 0), 2000, true);
  b.ready();
  const double sign = GENERATE(-1.0, 1.0);  // of the velocity with which the second leaves the first
  b.set_velocity([&](const Vec3& x) { return x[0] > 0.05 ? Vec3(sign * 2, 1, 0) : Vec3::Zero(); });
  const Components a = b.acceleration();
  const double h = 0.13, r = 0.1;
  const double f = sph::WendlandC2<3>::f(r, 1 / h);
  // v_ij.x_ij of the first particle is (0 - sign 2)(0 - r).
  const double along = std::min(sign * 2 * r, 0.0);
  const double expected =
      b.cell_mass() * kAlpha * kSound * h * along / (7000 * (r * r + 0.01 * h * h)) * f * -r;
  const Index first = b.patch.x[0][0] < 0.05 ? 0 : 1;
  CHECK(a[0][first] == Approx(expected).margin(1e-12));
  CHECK(a[0][1 - first] == Approx(-expected).margin(1e-12));
  CHECK(a[1][first] == 0);
  if (sign < 0) CHECK(a[0][first] < 0);  // pushed away from the one that comes
}

TEST_CASE("artificial viscosity conserves momentum and takes energy") {
  Liquid b(2);
  b.fill(Vec3::Zero(), Vec3(1, 1, 0), 2000);
  b.jitter(0.2);
  b.ready();
  b.set_velocity([](const Vec3& x) { return Vec3(std::sin(6 * x[1]), std::cos(5 * x[0]), 0); });
  const Components a = b.acceleration();
  Vec3 sum = Vec3::Zero();
  double size = 0, power = 0;
  for (Index i = 0; i < b.patch.size(); ++i) {
    sum += b.patch.mass[i] * b.vector(a, i);
    size += b.patch.mass[i] * b.vector(a, i).norm();
    power += b.patch.mass[i] * b.vector(a, i).dot(b.vector(b.patch.v, i));
  }
  CHECK(sum.norm() < 1e-13 * size);
  CHECK(power < 0);
}

TEST_CASE("artificial viscosity drags on no-slip walls and not on slip walls") {
  const bool no_slip = GENERATE(true, false);
  Liquid b(2);
  b.fill(Vec3::Zero(), Vec3(1, 0.1, 0), 2000);
  b.dummies(4, Vec3::Zero(), Vec3(1, 1, 0), 2000, 0.3);
  b.constants.faces[4].no_slip = no_slip;
  b.ready();
  for (Index i = 0; i < b.patch.size(); ++i) b.patch.v[0][i] = b.patch.wall[i] ? 0.0 : 1.0;
  const Components a = b.acceleration();
  for (Index i = 0; i < b.patch.size(); ++i) {
    if (b.patch.wall[i]) continue;
    if (no_slip)
      CHECK(a[0][i] < 0);
    else
      CHECK(a[0][i] == 0);
  }
}
