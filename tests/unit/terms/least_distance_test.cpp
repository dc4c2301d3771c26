// SPDX-License-Identifier: MIT
#include "meltray/terms/least_distance.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "unit/terms/stage_setup.hpp"

using namespace meltray;
using meltray::test::StageSetup;

namespace {

constexpr double kDx = 5e-5, kParting = 4e-6;

Components displace(const StageSetup& s, double dt) {
  Components moved = s.zeros();
  terms::LeastDistance{0.8, kParting}.displace(s.stage, dt, view(moved));
  return moved;
}

double distance(const StageSetup& s, Index i, Index j) {
  return (s.position(i) - s.position(j)).norm();
}

/// Two particles of melt, or one beside solid, `apart` from each other with nothing around.
void lonely_pair(StageSetup& s, double apart, bool both_melt) {
  const Vec3 x(5 * kDx, 5 * kDx, s.constants.dim == 3 ? 5 * kDx : 0);
  s.add(x, 2000, true);
  s.add(x + Vec3(apart, 0, 0), both_melt ? 2000 : 1000, both_melt);
  s.prepare(Vec3::Zero(), Vec3::Constant(10 * kDx));
}

/// One layer of melt on three of solid, jittered.
void film_on_solid(StageSetup& s, double jitter) {
  const Vec3 max(10 * kDx, 10 * kDx, 3 * kDx);
  s.fill(Vec3::Zero(), max, 1000, false);
  s.fill(Vec3(0, 0, 3 * kDx), Vec3(max[0], max[1], 4 * kDx), 2000, true);
  s.jitter(jitter);
  s.prepare(Vec3::Constant(-kDx), max + Vec3::Constant(3 * kDx));
}

double nearest(const StageSetup& s) {
  double least = 1;
  for (Index i : s.stage.moving)
    for (Index j = 0; j < s.patch.size(); ++j)
      if (j != i) least = std::min(least, distance(s, i, j));
  return least;
}

}  // namespace

TEST_CASE("least distance: melt is parted at the rate of the lacking distance, its centre stays") {
  for (int dim : {2, 3}) {
    CAPTURE(dim);
    StageSetup s(dim, kDx);
    lonely_pair(s, 0.5 * kDx, true);
    REQUIRE(s.stage.surface[0] == 1);
    const double dt = 0.1 * kParting;
    const auto moved = displace(s, dt);
    // Each takes half of its share of what is lacking: the pair gains half of 0.3 dx dt / parting.
    const double gain = std::abs(moved[0][1] - moved[0][0]);
    CHECK(gain == Approx(0.5 * 0.3 * kDx * dt / kParting));
    CHECK(moved[0][0] + moved[0][1] == Approx(0).margin(1e-12 * kDx));
    CHECK(moved[1][0] == 0);
    CHECK((moved[0][1] - moved[0][0]) * (s.position(1) - s.position(0))[0] > 0);
  }
}

TEST_CASE("least distance: a long step takes a quarter of what is lacking, never more") {
  StageSetup s(3, kDx);
  lonely_pair(s, 0.5 * kDx, true);
  const auto moved = displace(s, 100 * kParting);
  CHECK(std::abs(moved[0][1] - moved[0][0]) == Approx(0.25 * 0.3 * kDx));
}

TEST_CASE("least distance: beside solid only the melt moves") {
  StageSetup s(3, kDx);
  lonely_pair(s, 0.5 * kDx, false);
  REQUIRE(s.stage.moving.size() == 1);
  const Index melt = s.stage.moving[0];
  const double dt = 0.1 * kParting;
  const auto moved = displace(s, dt);
  CHECK(std::abs(moved[0][melt]) == Approx(0.5 * 0.3 * kDx * dt / kParting));
  CHECK(moved[0][1 - melt] == 0);
}

TEST_CASE("least distance: nothing to do on a lattice, nor inside") {
  StageSetup lattice(3, kDx);
  film_on_solid(lattice, 0);
  StageSetup inside(3, kDx);
  const Vec3 max = Vec3::Constant(9 * kDx);
  inside.fill(Vec3::Zero(), max, 2000);
  inside.particles.x[0][0] += 0.25 * kDx;
  inside.prepare(Vec3::Zero(), max, {true, true, true});
  REQUIRE(nearest(inside) < 0.8 * kDx);
  REQUIRE(*std::max_element(inside.stage.surface.begin(), inside.stage.surface.end()) == 0);
  for (const StageSetup* s : {&lattice, &inside}) {
    const auto moved = displace(*s, kParting);
    for (int c = 0; c < 3; ++c)
      for (double x : moved[c]) CHECK(x == 0);
  }
}

TEST_CASE("least distance: a disordered film is parted within a few steps") {
  StageSetup s(3, kDx);
  film_on_solid(s, 0.3);
  const double before = nearest(s);
  REQUIRE(before < 0.6 * kDx);
  for (int step = 0; step < 20; ++step) {
    const auto moved = displace(s, 0.5 * kParting);
    for (int c = 0; c < 3; ++c)
      for (Index i : s.stage.moving) s.patch.x[c][i] += moved[c][i];
    s.update();
  }
  CHECK(nearest(s) > 0.78 * kDx);
}
