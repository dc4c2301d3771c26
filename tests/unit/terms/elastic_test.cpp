// SPDX-License-Identifier: MIT
#include "meltray/terms/elastic.hpp"

#include <catch2/catch.hpp>

#include "meltray/terms/pressure/acoustic_pass.hpp"
#include "unit/terms/stage_setup.hpp"

using namespace meltray;
using namespace meltray::terms;
using meltray::test::StageSetup;

namespace {

using Tensor = Eigen::Matrix3d;

constexpr double kBulk = 160e9, kShear = 80e9, kSoundOfMelt = 40;
/// Distances of pairs are kept in single precision, 6e-8 relative; a corner of a jittered block loses a
/// digit.
constexpr double kSingle = 1e-6;

ElasticSolid metal() {
  ElasticSolid solid;
  solid.bulk_modulus = kBulk;
  solid.shear_modulus = kShear;
  solid.viscosity = solid.artificial_stress = 0;
  return solid;
}

/// Block of elastic solid of spacing 0.1 from 0 to `size`, off the lattice where asked for.
struct Block : StageSetup {
  explicit Block(int dim, double displacement = 0, double melt_from = 1e9) : StageSetup(dim, 0.1) {
    const double side = dim == 2 ? 1 : 0.6;
    for_lattice(Vec3::Zero(), Vec3::Constant(side),
                [&](const Vec3& x) { add(x, x[0] > melt_from ? 2000 : 300, x[0] > melt_from); });
    if (displacement > 0) jitter(displacement);
    start();
  }
  /// A block with a wall at x = 0.
  Block(int dim, bool no_slip) : StageSetup(dim, 0.1) {
    const Vec3 size(0.6, 1, dim == 2 ? 0 : 1);
    fill(Vec3::Zero(), size, 300, false);
    dummies(0, Vec3::Zero(), size, 300, 0.3);
    constants.faces[0].no_slip = no_slip;
    start();
  }
  /// Two particles of spacing 0.1 in x, the first of them solid.
  explicit Block(bool melt) : StageSetup(3, 0.1) {
    add(Vec3::Zero(), 300, false);
    add(Vec3(0.1, 0, 0), melt ? 2000 : 300, melt);
    start();
  }
  void start() {
    particles.density.assign(particles.size(), constants.density);
    for (int c = 0; c < symmetric_count(constants.dim); ++c) particles.stress[c].assign(particles.size(), 0);
    prepare(Vec3::Constant(-0.6), Vec3::Constant(1.6));
    selector.mark_elastic(particles, patch, 1);
    prepare_stage(stage);
    update();
  }
  Tensor stress(Index i) const {
    return tensor([&](int c) { return patch.stress[c][i]; });
  }
  template <class F>
  Tensor tensor(F&& component) const {
    Tensor t = Tensor::Zero();
    int n = 0;
    for (int a = 0; a < constants.dim; ++a)
      for (int b = a; b < constants.dim; ++b) t(a, b) = t(b, a) = component(n++);
    return t;
  }
  /// Any stress and density for every particle, of the size of strains of 1e-3.
  void set_noise() {
    test::Noise noise(7);
    for (Index i = 0; i < patch.size(); ++i) {
      patch.density[i] = constants.density * (1 + 1e-3 * noise());
      for (int c = 0; c < symmetric_count(constants.dim); ++c) patch.stress[c][i] = 1e-3 * kShear * noise();
    }
  }
  struct Result {
    Components acceleration;
    std::vector<double> density;
    SymmetricComponents stress;
  };
  Result rates(const ElasticSolid& solid) {
    Result r{zeros(), std::vector<double>(patch.size(), 0.0), {}};
    Rates rates{view(r.acceleration), nullptr, r.density.data(), {}};
    for (int c = 0; c < symmetric_count(constants.dim); ++c) {
      r.stress[c].assign(patch.size(), 0.0);
      rates.stress[c] = r.stress[c].data();
    }
    solid.update(stage);
    solid.add_rates(stage, rates);
    return r;
  }
  /// Acceleration of the melt in a weakly compressible scene whose speed of sound is 40.
  Components of_melt(double alpha) {
    AcousticPass pass;
    pass.state = {kSoundOfMelt, false, Tension::full};
    pass.force.form = GradientForm::sum;
    pass.artificial.alpha = alpha;
    evaluate(pass);
    Components a = zeros();
    std::vector<double> rate(patch.size());
    pass.add_rates(stage, rate.data(), view(a));
    return a;
  }
};

/// A velocity gradient with strain, dilation and spin.
Tensor gradient(int dim) {
  Tensor a;
  a << 0.3, -0.7, 0.2, 0.4, 0.1, 0.5, -0.6, 0.2, -0.2;
  if (dim == 2) {
    a.row(2).setZero();
    a.col(2).setZero();
  }
  return a;
}

Tensor spin_of(const Tensor& a) {
  return 0.5 * (a - a.transpose());
}

}  // namespace

TEST_CASE("stress rate of a given velocity gradient, at the surface too") {
  const int dim = GENERATE(2, 3);
  Block b(dim, 0.2);
  b.set_noise();
  const Tensor a = gradient(dim), strain = 0.5 * (a + a.transpose());
  b.set_velocity([&](const Vec3& x) { return Vec3(a * x); });
  const auto r = b.rates(metal());
  for (Index i = 0; i < b.patch.size(); ++i) {
    const Tensor s = b.stress(i);
    const Tensor expected =
        2 * kShear * (strain - strain.trace() / 3 * Tensor::Identity()) + spin_of(a) * s - s * spin_of(a);
    const Tensor found = b.tensor([&](int c) { return r.stress[c][i]; });
    for (int p = 0; p < dim; ++p)
      for (int q = 0; q < dim; ++q) CHECK(found(p, q) == Approx(expected(p, q)).margin(kSingle * kShear));
    CHECK(r.density[i] == Approx(-b.patch.density[i] * strain.trace()).epsilon(kSingle));
  }
}

TEST_CASE("a rigid rotation turns stress without changing it") {
  const int dim = GENERATE(2, 3);
  Block b(dim, 0.2);
  b.set_noise();
  const Tensor w = spin_of(gradient(dim));
  b.set_velocity([&](const Vec3& x) { return Vec3(w * x); });
  const auto r = b.rates(metal());
  for (Index i = 0; i < b.patch.size(); ++i) {
    const Tensor s = b.stress(i), rate = b.tensor([&](int c) { return r.stress[c][i]; });
    CHECK((rate - (w * s - s * w)).norm() < kSingle * kShear);
    // The invariants of S stay: their rates are tr dS/dt and 2 S : dS/dt.
    CHECK(std::abs((s * rate).trace()) < kSingle * kShear * s.norm());
    CHECK(std::abs(r.density[i]) < kSingle * b.patch.density[i]);
  }
}

TEST_CASE("the elastic force keeps both momenta and does the work that the stress takes up") {
  const int dim = GENERATE(2, 3);
  Block b(dim, 0.2);
  b.set_noise();
  test::Noise noise(3);
  b.set_velocity([&](const Vec3&) { return Vec3(noise(), noise(), noise()); });
  const auto r = b.rates(metal());
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  double size = 0, power = 0, stored = 0;
  for (Index i = 0; i < b.patch.size(); ++i) {
    const double m = b.patch.mass[i], rho = b.patch.density[i];
    const Vec3 a = b.vector(r.acceleration, i);
    force += m * a;
    torque += m * b.position(i).cross(a);
    size += m * a.norm();
    power += m * a.dot(b.vector(b.patch.v, i));
    // sigma : D from the rates: S : (dS/dt) / 2G, of which the spin drops out, and -p tr D. In plane strain
    // the trace of S is not zero, and S : dev D lacks a third of tr S tr D.
    const Tensor s = b.stress(i), rate = b.tensor([&](int c) { return r.stress[c][i]; });
    const double dilation = -r.density[i] / rho, p = kBulk * (rho / b.constants.density - 1);
    stored += m / rho * ((s * rate).trace() / (2 * kShear) + s.trace() * dilation / 3 - p * dilation);
  }
  CHECK(force.norm() < 1e-12 * size);
  CHECK(torque.norm() < kSingle * size);
  CHECK(power == Approx(-stored).epsilon(kSingle));
}

TEST_CASE("uniform stress is at rest inside and behind walls that hold it") {
  const int dim = GENERATE(2, 3);
  const bool no_slip = GENERATE(true, false);
  Block b(dim, no_slip);
  for (Index i = 0; i < b.patch.size(); ++i) b.patch.stress[0][i] = 1e-3 * kShear;
  ElasticSolid solid = metal();
  solid.artificial_stress = GENERATE(0.0, 0.3);
  const auto r = b.rates(solid);
  // A free face of this stress pulls at its layer with about stress / (rho dx).
  const double face = 1e-3 * kShear / (7000 * 0.1);
  int near = 0;
  for (Index i = 0; i < b.patch.size(); ++i) {
    if (b.patch.wall[i] || b.patch.x[0][i] > 0.3) continue;
    bool inside = true;
    for (int c = 1; c < dim; ++c) inside = inside && b.patch.x[c][i] > 0.25 && b.patch.x[c][i] < 0.75;
    if (!inside) continue;
    CHECK(b.vector(r.acceleration, i).norm() < 1e-2 * face);
    ++near;
  }
  CHECK(near > 3);
}

TEST_CASE("a wall holds the velocity on its face: all of it, or the part along its normal") {
  const bool no_slip = GENERATE(true, false);
  Block b(2, no_slip);
  // Stretch and shear off a face that holds; a sliding motion along one that only keeps contact.
  const auto velocity = [&](const Vec3& x) { return Vec3(2 * x[0], no_slip ? 3 * x[0] : 4.0, 0); };
  b.set_velocity(velocity);
  for (Index i = 0; i < b.patch.size(); ++i)
    if (b.patch.wall[i]) b.patch.v[0][i] = b.patch.v[1][i] = 0;
  const auto r = b.rates(metal());
  for (Index i = 0; i < b.patch.size(); ++i) {
    if (b.patch.wall[i]) continue;
    CHECK(r.density[i] == Approx(-2 * 7000).epsilon(kSingle));
    CHECK(r.stress[1][i] == Approx(no_slip ? 3 * kShear : 0.0).margin(kSingle * kShear));
  }
}

TEST_CASE("heated solid is under the pressure 3 K alpha dT until it expands") {
  SceneConstants k;
  k.density = 7000;
  k.material = test::plain_metal();
  ElasticSolid solid = metal();
  solid.expansion = 12e-6;
  CHECK(solid.reference_density(k, k.melting_temperature()) == 7000);
  const double cold = solid.reference_density(k, 300);
  CHECK(solid.pressure(cold, solid.reference_density(k, 310)) ==
        Approx(3 * kBulk * 12e-6 * 10).epsilon(1e-3));
  CHECK(solid.sound_speed(7000) == Approx(std::sqrt((kBulk + 4 * kShear / 3) / 7000)));
}

TEST_CASE("what the melt does to the solid, the solid does to the melt") {
  const int dim = GENERATE(2, 3);
  Block b(dim, 0.1, dim == 2 ? 0.5 : 0.3);
  for (Index i = 0; i < b.patch.size(); ++i)
    if (b.patch.liquid[i]) b.patch.density[i] = b.constants.density * (1 + 0.01 * b.position(i)[1]);
  const Components melt = b.of_melt(0);
  const auto r = b.rates(metal());
  Vec3 on_solid = Vec3::Zero(), on_melt = Vec3::Zero();
  for (Index i = 0; i < b.patch.size(); ++i) {
    on_solid += b.patch.mass[i] * b.vector(r.acceleration, i);
    on_melt += b.patch.mass[i] * b.vector(melt, i);
  }
  CHECK(on_solid[0] < 0);
  // The solid takes its pairs from the list, in single precision.
  CHECK((on_solid + on_melt).norm() < 1e-7 * on_solid.norm());
}

TEST_CASE("artificial viscosity of a pair: in the solid by its sound, with melt by that of the melt") {
  const bool melt = GENERATE(false, true);
  const double alpha = 0.3;
  Block b(melt);
  const double sign = GENERATE(-1.0, 1.0);  // of the velocity with which the second leaves the first
  b.set_velocity([&](const Vec3& x) { return x[0] > 0.05 ? Vec3(sign * 2, 1, 0) : Vec3::Zero(); });
  ElasticSolid solid = metal();
  (melt ? solid.melt_drag : solid.viscosity) = melt ? alpha * kSoundOfMelt : alpha;
  const double sound = melt ? kSoundOfMelt : std::sqrt((kBulk + 4 * kShear / 3) / 7000);
  const double h = 0.13, r = 0.1;
  const double f = sph::WendlandC2<3>::f(r, 1 / h);
  // v_ij.x_ij of the first particle is (0 - sign 2)(0 - r).
  const double along = std::min(sign * 2 * r, 0.0);
  const double expected =
      b.cell_mass() * alpha * sound * h * along / (7000 * (r * r + 0.01 * h * h)) * f * -r;
  const Components of_solid = b.rates(solid).acceleration;
  const Components of_second = melt ? b.of_melt(alpha) : of_solid;
  const Index first = b.patch.x[0][0] < 0.05 ? 0 : 1;
  CHECK(of_solid[0][first] == Approx(expected).epsilon(kSingle));
  CHECK(of_second[0][1 - first] == Approx(-expected).epsilon(kSingle));
  CHECK(of_solid[1][first] == 0);
  if (sign < 0) CHECK(of_solid[0][first] < 0);  // pushed away from the one that comes
}

TEST_CASE("drag between melt and elastic solid keeps momentum and takes energy") {
  const int dim = GENERATE(2, 3);
  Block b(dim, 0.1, dim == 2 ? 0.5 : 0.3);
  for (Index i = 0; i < b.patch.size(); ++i)
    if (b.patch.liquid[i]) b.patch.density[i] = b.constants.density * (1 + 0.01 * b.position(i)[1]);
  // Each body moves as a whole, towards the other and along it: within each there is nothing to slow down.
  for (Index i = 0; i < b.patch.size(); ++i) {
    b.patch.v[0][i] = b.patch.liquid[i] ? -2 : 3;
    b.patch.v[1][i] = b.patch.liquid[i] ? 1 : 0;
  }
  const double alpha = 0.3;
  ElasticSolid with_drag = metal();
  with_drag.melt_drag = alpha * kSoundOfMelt;
  const Components melt = b.of_melt(alpha), without_melt = b.of_melt(0);
  const Components solid = b.rates(with_drag).acceleration, without_solid = b.rates(metal()).acceleration;
  Vec3 on_solid = Vec3::Zero(), on_melt = Vec3::Zero();
  double power = 0;
  for (Index i = 0; i < b.patch.size(); ++i) {
    const Vec3 by_solid = b.patch.mass[i] * (b.vector(melt, i) - b.vector(without_melt, i));
    const Vec3 by_melt = b.patch.mass[i] * (b.vector(solid, i) - b.vector(without_solid, i));
    on_melt += by_solid;
    on_solid += by_melt;
    power += (by_solid + by_melt).dot(b.vector(b.patch.v, i));
  }
  CHECK(on_solid[0] < 0);
  CHECK((on_solid + on_melt).norm() < kSingle * on_solid.norm());
  CHECK(power < 0);
}

TEST_CASE("artificial stress pushes a close pair apart under tension only") {
  const double sign = GENERATE(1.0, -1.0);
  Block b(2);
  Index i = 0;  // a particle in the middle, and its neighbour in x
  const auto near = [&](double x) {
    for (Index k = 0; k < b.patch.size(); ++k)
      if ((b.position(k) - Vec3(x, 0.45, 0)).norm() < 1e-6) return k;
    return Index{-1};
  };
  i = near(0.45);
  const Index j = near(0.55);
  b.patch.x[0][i] += 0.03;
  b.patch.x[0][j] -= 0.03;
  b.update();
  for (Index k = 0; k < b.patch.size(); ++k) b.patch.stress[0][k] = sign * 1e-3 * kShear;
  const auto plain = b.rates(metal());
  ElasticSolid solid = metal();
  solid.artificial_stress = 0.3;
  const auto stressed = b.rates(solid);
  const double apart = (stressed.acceleration[0][j] - stressed.acceleration[0][i]) -
                       (plain.acceleration[0][j] - plain.acceleration[0][i]);
  if (sign > 0)
    CHECK(apart > 0);
  else
    CHECK(apart == 0);
}
