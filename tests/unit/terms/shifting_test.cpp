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
    const double dt = 0.05 * s.constants.smoothing;  // at 1 m/s: 0.05 h a step
    s.set_velocity([](const Vec3&) { return Vec3(0.6, 0.8, 0); });
    double last = before;
    for (int k = 0; k < 40; ++k) {
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

TEST_CASE("shifting: a nearly even set stays so at an advective Courant number of 0.2") {
  StageSetup s(3, kDx);
  periodic_block(s, 10, 0.05);
  const double before = unevenness(s), dt = 0.2 * s.constants.smoothing;
  s.set_velocity([](const Vec3&) { return Vec3(0.6, 0.8, 0); });
  for (int k = 0; k < 10; ++k) {
    const auto f = shift(s);
    for (int c = 0; c < 3; ++c)
      for (Index i = 0; i < s.patch.size(); ++i) s.patch.x[c][i] += dt * f.transport[c][i];
    s.update();
  }
  CHECK(unevenness(s) < before);
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

TEST_CASE("shifting: surface particles stay, the rest follow C, saturated at a fifth of their speed") {
  StageSetup s(3, kDx);
  const Vec3 max = Vec3::Constant(10 * kDx);
  s.fill(Vec3::Zero(), max, 2000);
  s.jitter(0.1);
  s.prepare(Vec3::Constant(-kDx), max + Vec3::Constant(kDx));
  s.set_velocity([](const Vec3&) { return Vec3(3, 0, 0); });
  const auto one = shift(s, 1), four = shift(s, 4);
  double worst = 0;
  int inner = 0;
  for (Index i = 0; i < s.patch.size(); ++i) {
    const Vec3 a = s.vector(one.transport, i), b = s.vector(four.transport, i);
    if (s.stage.surface[i] == 1) CHECK(b.norm() == 0);
    CHECK(b.norm() < 0.2 * 3);
    if (s.stage.surface[i] > 0 || a.norm() == 0) continue;
    ++inner;
    // |du| = u/(1 + u/(0.2 |v|)) with u proportional to C: 1/u = 1/|du| - 1/(0.2 |v|) falls to a quarter.
    const double first = 1 / a.norm() - 1 / 0.6, second = 1 / b.norm() - 1 / 0.6;
    worst = std::max({worst, std::abs(first / second / 4 - 1), (a.normalized() - b.normalized()).norm()});
  }
  CHECK(inner > 100);
  CHECK(worst < 1e-9);
}

TEST_CASE("shifting: pushes pairs apart that are closer than a spacing, and only those") {
  using Kernel = sph::WendlandC2<3>;
  for (const double spacings : {0.6, 0.9, 1.0, 1.4}) {
    CAPTURE(spacings);
    StageSetup s(3, kDx);
    const double distance = spacings * kDx, inverse_h = 1 / s.constants.smoothing;
    s.add(Vec3::Zero(), 2000, true);
    s.add(Vec3(distance, 0, 0), 2000, true);
    s.prepare(Vec3::Constant(-4 * kDx), Vec3::Constant(5 * kDx));
    s.set_velocity([](const Vec3&) { return Vec3(0, 1, 0); });
    // As if the two were inside the melt: a surface is not shifted.
    s.stage.surface.assign(2, 0.0);
    s.stage.loose.assign(2, 0);
    const double weak = 1e-6, slope = distance * Kernel::f(distance, inverse_h);
    const double ratio = Kernel::w(distance, inverse_h) / Kernel::w(kDx, inverse_h);
    const double push = 0.2 * std::max(std::pow(ratio, 4) - 1, 0.0);
    const double expected = weak * s.constants.smoothing * s.cell_volume() * slope * (1 + push);
    const auto f = shift(s, weak);
    CHECK(f.transport[0][0] == Approx(expected).epsilon(1e-4));
    CHECK(f.transport[0][1] == Approx(-expected).epsilon(1e-4));
  }
}
