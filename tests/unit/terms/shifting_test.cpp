// SPDX-License-Identifier: MIT
#include "meltray/terms/shifting.hpp"

#include <catch2/catch.hpp>

#include "unit/terms/stage_setup.hpp"

using namespace meltray;
using meltray::test::StageSetup;

namespace {

constexpr double kDx = 5e-5;

struct Shift {
  Components transport, acceleration;
};

Shift shift(const StageSetup& s, double coefficient = 4) {
  Shift out{s.zeros(), s.zeros()};
  terms::Shifting{coefficient}.add_rates(s.stage, view(out.transport), view(out.acceleration));
  return out;
}

double largest(const Components& f) {
  double m = 0;
  for (const auto& c : f)
    for (double x : c) m = std::max(m, std::abs(x));
  return m;
}

/// Standard deviation of the Shepard sum: how uneven particles are.
double unevenness(const StageSetup& s) {
  double sum = 0, square = 0;
  for (double f : s.stage.fill) {
    sum += f;
    square += f * f;
  }
  const double n = static_cast<double>(s.stage.fill.size()), mean = sum / n;
  return std::sqrt(square / n - mean * mean);
}

void periodic_block(StageSetup& s, int cells, double jitter) {
  Vec3 max = Vec3::Constant(cells * kDx);
  s.fill(Vec3::Zero(), max, 2000);
  s.jitter(jitter);
  s.prepare(Vec3::Zero(), max, {true, true, s.constants.dim == 3});
}

}  // namespace

TEST_CASE("shifting: none on a lattice, none at rest") {
  StageSetup s(3, kDx);
  periodic_block(s, 9, 0);
  s.set_velocity([](const Vec3&) { return Vec3(1, 2, 0); });
  CHECK(largest(shift(s).transport) < 1e-12);
  StageSetup jittered(3, kDx);
  periodic_block(jittered, 9, 0.3);
  CHECK(largest(shift(jittered).transport) == 0);
}

TEST_CASE("shifting: evens out a jittered set") {
  for (int dim : {2, 3}) {
    CAPTURE(dim);
    StageSetup s(dim, kDx);
    periodic_block(s, dim == 3 ? 10 : 24, 0.25);
    const double before = unevenness(s);
    const double dt = 0.1 * s.constants.smoothing;  // at 1 m/s: 0.1 h a step
    s.set_velocity([](const Vec3&) { return Vec3(0.6, 0.8, 0); });
    double last = before;
    for (int k = 0; k < 20; ++k) {
      const auto f = shift(s);
      CHECK(largest(f.acceleration) < 1e-9);  // nothing to carry along in a uniform flow
      for (int c = 0; c < dim; ++c)
        for (Index i = 0; i < s.patch.size(); ++i) s.patch.x[c][i] += dt * f.transport[c][i];
      s.update();
      if (k < 5) CHECK(unevenness(s) < last);
      last = unevenness(s);
    }
    CHECK(last < 0.5 * before);
  }
}

TEST_CASE("shifting: the velocity carried along is du . grad v") {
  StageSetup s(3, kDx);
  const Vec3 max = Vec3::Constant(14 * kDx);
  s.fill(Vec3::Zero(), max, 2000);
  s.jitter(0.1);
  s.prepare(Vec3::Constant(-kDx), max + Vec3::Constant(kDx));
  Eigen::Matrix3d gradient;
  gradient << 1, -2, 0.5, 3, -1, 2, 0, 1, 0;
  gradient *= 1e4;
  s.set_velocity([&](const Vec3& x) -> Vec3 { return gradient * x; });
  const auto f = shift(s);
  double error = 0, size = 0;
  for (Index i = 0; i < s.patch.size(); ++i) {
    const Vec3 x = s.position(i) / kDx;
    if ((x.array() < 4).any() || (x.array() > 10).any()) continue;
    const Vec3 exact = gradient * s.vector(f.transport, i);
    error += (s.vector(f.acceleration, i) - exact).squaredNorm();
    size += exact.squaredNorm();
  }
  REQUIRE(size > 0);
  // The plain gradient of a linear field on a set jittered by 0.1 dx.
  CHECK(std::sqrt(error / size) < 0.06);
}

TEST_CASE("shifting: surface particles stay, and the coefficient scales the rest") {
  StageSetup s(3, kDx);
  test::Noise noise(1);
  const Vec3 max = Vec3::Constant(10 * kDx);
  s.fill(Vec3::Zero(), max, 2000);
  s.jitter(0.1);
  s.prepare(Vec3::Constant(-kDx), max + Vec3::Constant(kDx));
  s.set_velocity([](const Vec3&) { return Vec3(1, 0, 0); });
  const auto one = shift(s, 1), four = shift(s, 4);
  double scaled = 0;
  for (Index i = 0; i < s.patch.size(); ++i) {
    if (s.stage.surface[i] == 1) CHECK(s.vector(four.transport, i).norm() == 0);
    scaled = std::max(scaled, (4 * s.vector(one.transport, i) - s.vector(four.transport, i)).norm());
  }
  CHECK(scaled < 1e-12);
  CHECK(largest(four.transport) > 0);
}
