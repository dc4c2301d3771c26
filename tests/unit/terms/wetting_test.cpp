// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "meltray/terms/surface_forces.hpp"
#include "unit/terms/stage_setup.hpp"

using namespace meltray;
using meltray::test::StageSetup;

namespace {

constexpr double kDx = 5e-5;

void turn(StageSetup& s, double contact_angle_deg) {
  terms::Wetting wetting;
  wetting.contact_angle_deg = contact_angle_deg;
  wetting.turn_normals(s.stage);
}

/// Liquid for x < 10 dx on solid that fills z < 5 dx everywhere: the triple line runs along y.
void quarter(StageSetup& s) {
  const int up = s.constants.dim - 1;
  Vec3 max = Vec3::Constant(18 * kDx);
  if (s.constants.dim == 3) max[1] = 9 * kDx;
  s.for_lattice(Vec3::Zero(), max, [&](const Vec3& x) {
    if (x[up] < 5 * kDx)
      s.add(x, 1000, false);
    else if (x[0] < 10 * kDx && x[up] < 16 * kDx)
      s.add(x, 2000, true);
  });
  s.prepare(Vec3::Zero(), max, {false, s.constants.dim == 3, false});
}

}  // namespace

TEST_CASE("wetting: at the wall the normal makes the contact angle, away from it stays") {
  for (int dim : {2, 3})
    for (double theta : {0.0, 10.0, 60.0, 90.0, 150.0}) {
      CAPTURE(dim, theta);
      StageSetup s(dim, kDx);
      quarter(s);
      const auto before = s.stage.normal;
      turn(s, theta);
      const int up = dim - 1;
      int touched = 0, wrong = 0;
      for (Index i = 0; i < s.patch.size(); ++i) {
        const Vec3 x = s.position(i) / kDx, n = s.vector(s.stage.normal, i);
        const bool same = (n - s.vector(before, i)).norm() < 1e-12;
        if (!s.patch.liquid[i] || s.stage.surface[i] == 0) {
          wrong += !same;
          continue;
        }
        wrong += std::abs(n.norm() - 1) > 1e-12;
        if (x[up] > 8) wrong += !same;  // out of reach of the wall
        if (x[0] > 9 && x[up] < 6) {
          // The liquid particle in the corner: the angle is measured through the liquid from the wall (-z)
          // side.
          ++touched;
          const double angle = theta * M_PI / 180;
          wrong += std::abs(n[up] - std::cos(angle)) > 0.02;
          wrong += std::abs(n[0] - std::sin(angle)) > 0.02;
        }
      }
      CHECK(touched == (dim == 3 ? 9 : 1));
      CHECK(wrong == 0);
    }
}

TEST_CASE("wetting: a surface parallel to the wall has no triple line") {
  StageSetup s(3, kDx);
  const Vec3 max(9 * kDx, 9 * kDx, 7 * kDx);
  s.for_lattice(Vec3::Zero(), max,
                [&](const Vec3& x) { s.add(x, x[2] < 5 * kDx ? 1000 : 2000, x[2] > 5 * kDx); });
  s.prepare(Vec3::Zero(), max + Vec3(0, 0, 4 * kDx), {true, true, false});
  const auto before = s.stage.normal;
  turn(s, 30);
  CHECK(s.stage.normal == before);
}

// However little its normals differ from the wall's: a film one particle thick ran at 0.4 m/s.
TEST_CASE("wetting: a film whose particles are out of place by a hundredth has no triple line") {
  StageSetup s(3, kDx);
  const Vec3 max(9 * kDx, 9 * kDx, 6 * kDx);
  s.for_lattice(Vec3::Zero(), max,
                [&](const Vec3& x) { s.add(x, x[2] < 5 * kDx ? 1000 : 2000, x[2] > 5 * kDx); });
  s.jitter(0.01);
  s.prepare(Vec3::Zero(), max + Vec3(0, 0, 4 * kDx), {true, true, false});
  const auto before = s.stage.normal;
  turn(s, 30);
  CHECK(s.stage.normal == before);
}

// The curvature along an upright face adds up to the turn of the normal between wall and face, so that the
// surface pulls at the line with Young's sigma cos(theta), on a lattice 1.0 to 1.6 times as strongly. While
// averaging normals undid the turn, nothing was left of it at 120 degrees.
TEST_CASE("wetting: an upright face is pulled along the wall by sigma cos theta") {
  for (double theta : {45.0, 60.0, 120.0, 135.0}) {
    StageSetup s(2, kDx);
    quarter(s);
    turn(s, theta);
    std::vector<double> pressure;
    terms::SurfaceTension{}.pressure(s.stage, pressure);
    double pull = 0;
    for (Index i = 0; i < s.patch.size(); ++i) {
      const Vec3 x = s.position(i) / kDx;
      if (s.patch.liquid[i] && x[0] > 9 && x[1] < 12) pull -= pressure[i] * kDx;
    }
    const double young = s.constants.material.sigma(2000) * std::cos(theta * M_PI / 180);
    CAPTURE(theta, pull / young);
    CHECK(pull / young > 0.85);
    CHECK(pull / young < 1.7);
  }
}
