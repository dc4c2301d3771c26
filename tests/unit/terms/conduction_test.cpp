// SPDX-License-Identifier: MIT
#include "meltray/terms/conduction.hpp"

#include <catch2/catch.hpp>

#include "unit/terms/stage_setup.hpp"

using namespace meltray;
using meltray::test::Noise;
using meltray::test::StageSetup;
using terms::ConductionOperator;

namespace {

constexpr double kDx = 5e-5;
constexpr double kLambda = 35, kCapacity = 7000.0 * 700;

std::vector<double> heating(const StageSetup& s, const ConductionOperator& op, double* power = nullptr) {
  std::vector<double> out(s.patch.size(), 0.0);
  const double p = op.add_heating(s.stage, out.data());
  if (power) *power = p;
  return out;
}

}  // namespace

TEST_CASE("conduction: a linear profile between walls at its end temperatures is steady") {
  for (int dim : {2, 3}) {
    StageSetup s(dim, kDx);
    const Vec3 max = Vec3::Constant(12 * kDx);
    s.fill(Vec3::Zero(), max, 1000, false);
    s.dummies(0, Vec3::Zero(), max, 400);
    s.dummies(1, Vec3::Zero(), max, 1000);
    s.constants.any_isothermal = true;
    for (int f : {0, 1}) {
      s.constants.faces[f].isothermal = true;
      s.constants.faces[f].temperature = f ? 1000 : 400;
    }
    s.prepare(Vec3(-3 * kDx, 0, 0), max + Vec3(3 * kDx, 0, 0), {false, true, dim == 3});
    s.set_temperature([&](const Vec3& x) { return 400 + 600 * x[0] / max[0]; });
    ConductionOperator op;
    op.assemble(s.stage);
    double power = 0, worst = 0;
    const auto rate = heating(s, op, &power);
    // What a wall step of a kelvin over a spacing would give is the scale.
    const double flux = kLambda * 600 / max[0], scale = flux / (7000 * kDx);
    for (Index i = 0; i < s.patch.size(); ++i) worst = std::max(worst, std::abs(rate[i]) / scale);
    CHECK(worst < 5e-8);  // conductances of pairs are stored in single precision
    const double area = std::pow(max[1], dim - 1);
    CHECK(power == Approx(0).margin(1e-9 * flux * area));

    // With one of the walls insulated, the other takes exactly lambda grad T per area.
    s.constants.faces[0].isothermal = false;
    op.assemble(s.stage);
    heating(s, op, &power);
    CHECK(power == Approx(flux * area));
  }
}

TEST_CASE("conduction: a sine mode decays at the rate a k^2") {
  for (auto kernel : {sph::KernelType::wendland_c2, sph::KernelType::cubic_spline})
    for (int dim : {2, 3}) {
      StageSetup s(dim, kDx, test::plain_metal(), kernel);
      Vec3 max(40 * kDx, 9 * kDx, dim == 3 ? 9 * kDx : 0.0);
      const double k = 2 * M_PI / max[0], exact = kLambda / kCapacity * k * k;
      s.fill(Vec3::Zero(), max, 1000, false);
      s.prepare(Vec3::Zero(), max, {true, true, dim == 3});
      s.set_temperature([&](const Vec3& x) { return 1000 + 100 * std::sin(k * x[0]); });
      ConductionOperator op;
      op.assemble(s.stage);
      const auto rate = heating(s, op);
      double sum = 0, norm = 0;
      for (Index i = 0; i < s.patch.size(); ++i) {
        const double t = s.stage.temperature[i] - 1000;
        sum -= t * rate[i] / 700;
        norm += t * t;
      }
      CAPTURE(dim, static_cast<int>(kernel));
      CHECK(sum / norm == Approx(exact).epsilon(0.01));
      // And over time: Heun steps up to one decay time.
      const double dt = 0.25 / op.rate(s.stage);
      double t = 0;
      while (t < 1 / exact) {
        const auto h0 = s.patch.h;
        op.assemble(s.stage);
        const auto first = heating(s, op);
        for (Index i = 0; i < s.patch.size(); ++i) s.patch.h[i] = h0[i] + dt * first[i];
        for (Index i = 0; i < s.patch.size(); ++i) s.stage.temperature[i] = s.patch.h[i] / 700;
        const auto second = heating(s, op);
        for (Index i = 0; i < s.patch.size(); ++i) s.patch.h[i] = h0[i] + 0.5 * dt * (first[i] + second[i]);
        for (Index i = 0; i < s.patch.size(); ++i) s.stage.temperature[i] = s.patch.h[i] / 700;
        t += dt;
        if (dim == 3) break;
      }
      double amplitude = 0;
      for (Index i = 0; i < s.patch.size(); ++i)
        amplitude += 2 * (s.stage.temperature[i] - 1000) * std::sin(k * s.patch.x[0][i]) / s.patch.size();
      CHECK(std::log(100 / amplitude) / t == Approx(exact).epsilon(0.01));
    }
}

TEST_CASE("conduction: pairs conserve energy to round-off and the operator is symmetric") {
  auto metal = test::plain_metal();
  metal.conductivity_liquid = constant(70);
  StageSetup s(3, kDx, metal);
  const Vec3 max = Vec3::Constant(10 * kDx);
  s.fill(Vec3::Zero(), max, 1000, false);
  s.jitter(0.3);
  s.prepare(Vec3::Constant(-kDx), max + Vec3::Constant(kDx));
  Noise noise(4);
  s.set_temperature([&](const Vec3&) { return 1800 + 700 * noise(); });
  ConductionOperator op;
  op.assemble(s.stage);
  const auto apply = [&](std::vector<double> t) {
    s.stage.temperature = std::move(t);
    auto rate = heating(s, op);
    for (Index i = 0; i < s.patch.size(); ++i) rate[i] *= s.patch.mass[i];
    return rate;
  };
  const auto power = apply(s.stage.temperature);
  double net = 0, gross = 0;
  for (double p : power) {
    net += p;
    gross += std::abs(p);
  }
  CHECK(std::abs(net) < 1e-13 * gross);

  std::vector<double> u(s.patch.size()), w(s.patch.size());
  for (double& x : u) x = noise();
  for (double& x : w) x = noise();
  const auto au = apply(u), aw = apply(w);
  double uaw = 0, wau = 0, uau = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    uaw += u[i] * aw[i];
    wau += w[i] * au[i];
    uau += u[i] * au[i];
  }
  CHECK(uaw == Approx(wau).epsilon(1e-11));
  CHECK(uau < 0);
}

TEST_CASE("conduction: a jump of conductivity in series passes the flux of the harmonic mean") {
  // Liquid below, solid above: steady temperatures meet where lambda dT/dz is continuous.
  auto metal = test::plain_metal();
  metal.conductivity_liquid = constant(105);
  StageSetup s(2, kDx, metal);
  const Vec3 max(12 * kDx, 40 * kDx, 0);
  s.fill(Vec3::Zero(), max, 1000, false);
  s.prepare(Vec3::Zero(), max, {true, false, false});
  const double flux = 1e8, middle = 20 * kDx;
  s.set_temperature([&](const Vec3& x) {
    const double z = x[1] - middle;
    return z < 0 ? 1815 - flux / 105 * z : 1795 - flux / 35 * z;
  });
  // The jump of 20 K over the melting band is taken out so that the profile is continuous.
  for (Index i = 0; i < s.patch.size(); ++i)
    s.stage.temperature[i] = 1000 - flux / (s.patch.x[1][i] < middle ? 105 : 35) * (s.patch.x[1][i] - middle);
  ConductionOperator op;
  op.assemble(s.stage);
  const auto rate = heating(s, op);
  // Power that crosses the middle: what all particles above it gain, less what crosses a plane far above.
  double through = 0;
  for (Index i = 0; i < s.patch.size(); ++i)
    if (s.patch.x[1][i] > middle && s.patch.x[1][i] < 30 * kDx) through += s.patch.mass[i] * rate[i];
  // In steady state nothing stays; the residue is the error of the interface flux.
  CHECK(std::abs(through) < 0.05 * flux * max[0]);
}

TEST_CASE("conduction: a prescribed flux enters the first layer, all of it") {
  StageSetup s(3, kDx);
  const Vec3 max = Vec3::Constant(9 * kDx);
  s.fill(Vec3::Zero(), max, 1000, false);
  s.constants.faces[5].axis = 2;
  s.constants.faces[5].plane = max[2];
  s.constants.faces[5].flux = 3e7;
  s.prepare(Vec3::Zero(), max, {true, true, false});
  ConductionOperator op;
  op.assemble(s.stage);
  double power = 0, gained = 0, inside = 0;
  const auto rate = heating(s, op, &power);
  for (Index i = 0; i < s.patch.size(); ++i) {
    gained += s.patch.mass[i] * rate[i];
    if (s.patch.x[2][i] < max[2] - kDx) inside += std::abs(rate[i]);
  }
  CHECK(power == Approx(3e7 * max[0] * max[1]));
  CHECK(gained == Approx(power));
  CHECK(inside == 0);
}

TEST_CASE("conduction: the implicit solve is that of the dense matrix, walls and local losses included") {
  auto metal = test::plain_metal();
  metal.heat_capacity_liquid = 900;
  StageSetup s(3, kDx, metal);
  const Vec3 max(9 * kDx, 9 * kDx, 4 * kDx);
  s.fill(Vec3::Zero(), max, 1000, false);
  s.jitter(0.2);
  s.dummies(4, Vec3::Zero(), max, 500);
  s.constants.faces[4].isothermal = s.constants.any_isothermal = true;
  s.constants.faces[4].temperature = 500;
  s.prepare(Vec3(0, 0, -3 * kDx), max, {true, true, false});
  Noise noise(8);
  // Solid, liquid and the band: dT/dh differs from particle to particle.
  s.set_temperature([&](const Vec3&) { return 1805 + 300 * noise(); });
  ConductionOperator op;
  op.assemble(s.stage);
  const auto n = static_cast<Index>(s.stage.heated.size());

  // J by differences of add_heating with coefficients and walls assembled anew. The conductivity is constant
  // and T(h) piecewise linear, so a difference within one branch is exact.
  Eigen::MatrixXd system = Eigen::MatrixXd::Identity(n, n);
  const auto base = heating(s, op);
  std::vector<double> local(s.patch.size());
  for (double& l : local) l = -1e-4 * (1 + noise());
  const double gamma = 40 / op.rate(s.stage);
  for (Index c = 0; c < n; ++c) {
    const Index j = s.stage.heated[c];
    const double dh = 1.0, slope = metal.temperature_slope(s.patch.h[j]), kept = s.stage.temperature[j];
    s.stage.temperature[j] += dh * slope;
    ConductionOperator probe;
    probe.assemble(s.stage);
    const auto moved = heating(s, probe);
    s.stage.temperature[j] = kept;
    for (Index r = 0; r < n; ++r) {
      const Index i = s.stage.heated[r];
      system(r, c) -= gamma * (moved[i] - base[i]) / dh;
    }
    system(c, c) -= gamma * local[j] * slope / s.patch.mass[j];
  }
  std::vector<double> b(s.patch.size()), x(s.patch.size(), 0.0);
  Eigen::VectorXd rhs(n);
  for (double& v : b) v = 1e4 * noise();
  for (Index r = 0; r < n; ++r) rhs[r] = b[s.stage.heated[r]];
  const Eigen::VectorXd exact = system.partialPivLu().solve(rhs);
  const int iterations = op.solve(s.stage, gamma, local.data(), b.data(), x.data(), 1e-12, 1000);
  CHECK(iterations > 0);
  double worst = 0;
  for (Index r = 0; r < n; ++r) worst = std::max(worst, std::abs(x[s.stage.heated[r]] - exact[r]));
  // Differences of heating lose about ten digits of its 1e10 W/kg.
  CHECK(worst < 1e-5 * exact.cwiseAbs().maxCoeff());
  CHECK(op.solve(s.stage, gamma, local.data(), b.data(), x.data(), 1e-12, 2) == -1);

  // Gershgorin: between the largest diagonal and twice it lies the fastest mode of -J without losses.
  Eigen::MatrixXd j = (Eigen::MatrixXd::Identity(n, n) - system) / gamma;
  for (Index c = 0; c < n; ++c)
    j(c, c) -= local[s.stage.heated[c]] * metal.temperature_slope(s.patch.h[s.stage.heated[c]]) /
               s.patch.mass[s.stage.heated[c]];
  const double fastest = -j.eigenvalues().real().minCoeff();
  CHECK(fastest <= 2 * op.rate(s.stage) * (1 + 1e-6));
  CHECK(fastest >= op.rate(s.stage) * (1 - 1e-6));
}

TEST_CASE("conduction: a mode along a free surface decays there as fast as inside") {
  for (int dim : {2, 3}) {
    StageSetup s(dim, kDx);
    const Vec3 max(24 * kDx, dim == 3 ? 9 * kDx : 12 * kDx, 12 * kDx);
    const int normal = dim - 1;
    const double k = 2 * M_PI / max[0], exact = kLambda / kCapacity * k * k;
    s.fill(Vec3::Zero(), max, 1000, false);
    Vec3 room = Vec3::Zero();
    room[normal] = 3 * kDx;
    s.prepare(-room, max + room, {true, dim == 3, false});
    s.set_temperature([&](const Vec3& x) { return 1000 + 100 * std::sin(k * x[0]); });
    ConductionOperator op;
    op.assemble(s.stage);
    const auto rate = heating(s, op);
    std::array<double, 12> sum{}, norm{};
    for (Index i = 0; i < s.patch.size(); ++i) {
      const auto layer = static_cast<std::size_t>(s.patch.x[normal][i] / kDx);
      const double t = s.stage.temperature[i] - 1000;
      sum[layer] -= t * rate[i] / 700;
      norm[layer] += t * t;
    }
    for (const std::size_t layer : {0, 1, 2, 6, 11}) {
      CAPTURE(dim, layer, sum[layer] / norm[layer] / exact);
      CHECK(sum[layer] / norm[layer] == Approx(exact).epsilon(layer == 6 ? 0.01 : 0.05));
    }
  }
}
