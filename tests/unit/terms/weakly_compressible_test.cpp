// SPDX-License-Identifier: MIT
#include "meltray/terms/pressure/acoustic_pass.hpp"

#include <catch2/catch.hpp>

#include "unit/terms/stage_setup.hpp"

using namespace meltray;
using namespace meltray::terms;
using meltray::test::StageSetup;

namespace {

constexpr double kSound = 40;

AcousticPass pass_of(const EquationOfState& eos) {
  AcousticPass pass;
  pass.state = eos;
  return pass;
}

/// Liquid block [0, 1]^dim (2-D) or half of it (3-D) of spacing 0.1 in free space.
struct Block : StageSetup {
  explicit Block(int dim, double displacement = 0, Material material = test::plain_metal())
      : StageSetup(dim, 0.1, std::move(material)) {
    const Vec3 size = dim == 2 ? Vec3(1, 1, 0) : Vec3(0.8, 0.8, 0.8);
    fill(Vec3::Zero(), size, 2000);
    if (displacement > 0) jitter(displacement);
    particles.density.assign(particles.size(), constants.density);
    prepare(Vec3::Constant(-0.6), Vec3::Constant(1.6));
  }
  /// Density rho_0(T) + excess(x), volumes and pressures.
  template <class F>
  void set_excess(const EquationOfState& eos, F&& excess) {
    for (Index i = 0; i < patch.size(); ++i)
      patch.density[i] = eos.reference_density(constants, stage.temperature[i]) + excess(position(i));
    eos.update(stage);
  }
  std::vector<double> density_rate(AcousticPass& pass) {
    evaluate(pass);
    std::vector<double> rate(patch.size(), 0.0);
    Components force = zeros();
    pass.add_rates(stage, rate.data(), view(force));
    return rate;
  }
  /// Of the sum over pairs alone.
  Components pressure_force(AcousticPass& pass) {
    evaluate(pass);
    Components a = zeros();
    std::vector<double> rate(patch.size());
    pass.add_rates(stage, rate.data(), view(a));
    return a;
  }
  Components pressure_force(const EquationOfState& eos, GradientForm form) {
    AcousticPass pass = pass_of(eos);
    pass.force.form = form;
    return pressure_force(pass);
  }
  /// Sum of m a, over the sum of m |a|.
  double net_force(const Components& a) const {
    Vec3 sum = Vec3::Zero();
    double size = 0;
    for (Index i = 0; i < patch.size(); ++i) {
      sum += patch.mass[i] * vector(a, i);
      size += patch.mass[i] * vector(a, i).norm();
    }
    REQUIRE(size > 0);
    return sum.norm() / size;
  }
  bool deep(Index i, double away) const {
    for (int c = 0; c < constants.dim; ++c)
      if (patch.x[c][i] < away || patch.x[c][i] > (constants.dim == 2 ? 1.0 : 0.8) - away) return false;
    return true;
  }
};

Material expanding_metal() {
  Material m = test::plain_metal();
  m.density_of_t = linear(7000, -1.0, 1810);
  return m;
}

}  // namespace

TEST_CASE("equation of state, Eqs. (5) and (7)") {
  SceneConstants k;
  k.density = 7000;
  k.material = expanding_metal();
  const EquationOfState plain{kSound, false, Tension::full};
  CHECK(plain.reference_density(k, 2810) == 7000);
  CHECK(plain.pressure(10, 7000) == Approx(1600 * 10));
  CHECK(plain.pressure(-10, 7000) == Approx(-1600 * 10));
  CHECK(plain.pressure(-1000, 7000) == Approx(-1600 * plain.tear * 7000));
  const EquationOfState warm{kSound, true, Tension::none};
  CHECK(warm.reference_density(k, 2810) == Approx(6000));
  CHECK(warm.pressure(-10, 6000) == 0);
}

TEST_CASE("hot melt of density rho_0(T) has no pressure") {
  Block b(2, 0, expanding_metal());
  b.set_temperature([](const Vec3& x) { return 1900 + 500 * x[0]; });
  const EquationOfState eos{kSound, true, Tension::full};
  b.set_excess(eos, [](const Vec3&) { return 0.0; });
  for (Index i = 0; i < b.patch.size(); ++i) CHECK(std::abs(b.patch.pressure[i]) < 1e-6);
}

TEST_CASE("continuity, Eq. (2): uniform expansion thins, rotation does not") {
  const int dim = GENERATE(2, 3);
  Block b(dim);
  const EquationOfState eos{kSound, false, Tension::full};
  b.set_excess(eos, [](const Vec3&) { return 0.0; });
  AcousticPass pass = pass_of(eos);
  b.set_velocity([](const Vec3& x) { return Vec3(3 * x); });
  const auto expanding = b.density_rate(pass);
  // Inside, sums over the lattice are those that the second moment was made from.
  for (Index i = 0; i < b.patch.size(); ++i)
    if (b.deep(i, 0.3)) CHECK(expanding[i] == Approx(-3.0 * dim * 7000).epsilon(1e-12));
  b.set_velocity([](const Vec3& x) { return Vec3(-x[1], x[0], 0); });
  for (double r : b.density_rate(pass)) CHECK(std::abs(r) < 1e-11 * 7000);
}

TEST_CASE("the density of torn melt returns, that of thin melt does not") {
  Block b(2);
  const EquationOfState eos{kSound, false, Tension::full};
  const double share = GENERATE(0.9, 2.0);  // of what it can be thinner by
  b.set_excess(eos, [&](const Vec3&) { return -share * eos.tear * 7000; });
  b.update();
  AcousticPass pass = pass_of(eos);
  const auto rate = b.density_rate(pass);
  const double expected = share > 1 ? (share - 1) * eos.tear * 7000 * kSound / b.constants.smoothing : 0.0;
  for (Index i = 0; i < b.patch.size(); ++i)
    if (!b.stage.loose[i]) CHECK(rate[i] == Approx(expected));
}

TEST_CASE("pressure force: a linear pressure gives -grad p / rho, any pressure conserves momentum") {
  const int dim = GENERATE(2, 3);
  const Tension tension = GENERATE(Tension::full, Tension::none, Tension::artificial_stress);
  const EquationOfState eos{kSound, false, tension};
  Block lattice(dim);
  lattice.set_excess(eos, [](const Vec3& x) { return 0.1 * (1 + x[0]); });
  Components a = lattice.pressure_force(eos, GradientForm::sum);
  // Positive pressure: artificial stress adds 1 % of it times (W/W(dx))^4, here a sum over nearest
  // neighbours.
  const double share = tension == Tension::artificial_stress ? 0.02 : 1e-4;
  for (Index i = 0; i < lattice.patch.size(); ++i)
    if (lattice.deep(i, 0.3)) CHECK(a[0][i] == Approx(-kSound * kSound * 0.1 / 7000).epsilon(share));

  Block jittered(dim, 0.2);
  jittered.set_excess(eos, [](const Vec3& x) { return 20 * std::sin(7 * x[0]) * std::cos(5 * x[1]); });
  a = jittered.pressure_force(eos, GradientForm::sum);
  CHECK(jittered.net_force(a) < 1e-13);
}

TEST_CASE("pressure force, difference form: a pressure linear from the face inwards is exact at the face") {
  const int dim = GENERATE(2, 3);
  const int up = dim - 1;
  const EquationOfState eos{kSound, false, Tension::full};
  Block b(dim);
  const double top = dim == 2 ? 1.0 : 0.8;
  b.set_excess(eos, [&](const Vec3& x) { return 0.1 * (top - x[up]); });
  b.update();
  Components a = b.pressure_force(eos, GradientForm::difference);
  PressureForce{GradientForm::difference}.add_surface_force(b.stage, view(a));
  int found = 0;
  for (Index i = 0; i < b.patch.size(); ++i) {
    bool middle = b.patch.x[up][i] > top - 0.1;
    for (int c = 0; c < up; ++c) middle = middle && b.patch.x[c][i] > 0.3 && b.patch.x[c][i] < top - 0.3;
    if (!middle) continue;
    CHECK(a[up][i] == Approx(kSound * kSound * 0.1 / 7000).epsilon(1e-3));
    ++found;
  }
  CHECK(found >= 2);
}

TEST_CASE("pressure force, difference form: along the sum at the surface, no force from disorder inside") {
  Block b(2, 0.2);
  const EquationOfState eos{kSound, false, Tension::full};
  b.set_excess(eos, [](const Vec3&) { return 5.0; });
  b.update();
  const Components sum = b.pressure_force(eos, GradientForm::sum);
  Components difference = b.pressure_force(eos, GradientForm::difference);
  PressureForce{GradientForm::difference}.add_surface_force(b.stage, view(difference));
  // Of a uniform pressure the differences leave the surface part alone, scaled for a linear one.
  const double scale = b.constants.lattice.second_moment / b.constants.lattice.face_gradient;
  int surface = 0, inside = 0;
  for (Index i = 0; i < b.patch.size(); ++i) {
    if (b.stage.surface[i] == 1) {
      CHECK((b.vector(difference, i) - scale * b.vector(sum, i)).norm() < 1e-6 * b.vector(sum, i).norm());
      ++surface;
    } else if (b.stage.surface[i] == 0) {
      CHECK(b.vector(difference, i).norm() == 0);
      CHECK(b.vector(sum, i).norm() > 0);
      ++inside;
    }
  }
  CHECK(surface > 20);
  CHECK(inside > 20);
}

TEST_CASE("artificial stress repels under tension and hardly changes pressure") {
  Block b(2, 0.2);
  const auto acceleration = [&](Tension tension, double excess) {
    const EquationOfState eos{kSound, false, tension};
    b.set_excess(eos, [&](const Vec3&) { return excess; });
    return b.pressure_force(eos, GradientForm::sum);
  };
  // Work of the force on a uniform stretch, sum m a.x: tension pulls inwards, artificial stress less.
  const auto outward = [&](const Components& a) {
    double sum = 0;
    for (Index i = 0; i < b.patch.size(); ++i)
      sum += b.patch.mass[i] * b.vector(a, i).dot(b.position(i) - Vec3(0.5, 0.5, 0));
    return sum;
  };
  const double full = outward(acceleration(Tension::full, -20));
  const double stressed = outward(acceleration(Tension::artificial_stress, -20));
  CHECK(full < 0);
  CHECK(stressed > full);
  CHECK(outward(acceleration(Tension::none, -20)) == 0);
  CHECK(outward(acceleration(Tension::artificial_stress, 20)) ==
        Approx(outward(acceleration(Tension::full, 20))).epsilon(0.02));
}

TEST_CASE("a body of uniform pressure under the same surface pressure is at rest") {
  const int dim = GENERATE(2, 3);
  Block b(dim, 0.2);
  const double excess = 5, q = kSound * kSound * excess;
  const EquationOfState eos{kSound, false, Tension::full};
  b.set_excess(eos, [&](const Vec3&) { return excess; });
  b.update();
  b.stage.surface_pressure.assign(b.patch.size(), q);
  const PressureForce force{GENERATE(GradientForm::sum, GradientForm::difference)};
  double before = 0, after = 0;
  for (Index i = 0; i < b.patch.size(); ++i)
    before = std::max(before, 2 * q / 7000 * b.vector(b.stage.grad_c, i).norm());
  Components a = b.pressure_force(eos, force.form);
  force.add_surface_force(b.stage, view(a));
  for (Index i = 0; i < b.patch.size(); ++i) after = std::max(after, b.vector(a, i).norm());
  // The gradient of the colour function comes from pairs in single precision.
  CHECK(after < 1e-6 * before);
}

TEST_CASE("density diffusion conserves volume times excess and dissipates its noise") {
  const auto form = GENERATE(DiffusionForm::molteni_colagrossi, DiffusionForm::antuono);
  Block b(2, 0.2);
  test::Noise noise(3);
  const EquationOfState eos{kSound, false, Tension::full};
  b.set_excess(eos, [&](const Vec3&) { return 10 * noise(); });
  AcousticPass pass = pass_of(eos);
  pass.diffusion = {form, 0.1};
  const auto rate = b.density_rate(pass);
  double sum = 0, size = 0, work = 0;
  for (Index i = 0; i < b.patch.size(); ++i) {
    sum += b.stage.volume[i] * rate[i];
    size += b.stage.volume[i] * std::abs(rate[i]);
    work += b.stage.volume[i] * rate[i] * b.stage.excess[i];
  }
  CHECK(std::abs(sum) < 1e-13 * size);
  CHECK(work < 0);
}

TEST_CASE(
    "density diffusion: Antuono leaves a linear profile alone up to the surface, the plain form does not") {
  Block b(2, 0.2);
  const EquationOfState eos{kSound, false, Tension::full};
  b.set_excess(eos, [](const Vec3& x) { return 10 * (1 - x[1]); });
  const auto largest = [&](DiffusionForm form) {
    AcousticPass pass = pass_of(eos);
    pass.diffusion = {form, 0.1};
    double most = 0;
    for (double r : b.density_rate(pass)) most = std::max(most, std::abs(r));
    return most;
  };
  CHECK(largest(DiffusionForm::antuono) < 1e-10 * largest(DiffusionForm::molteni_colagrossi));
}

TEST_CASE("density diffusion does not smear a thermal profile of the density") {
  Block b(2, 0.2, expanding_metal());
  b.set_temperature([](const Vec3& x) { return 1900 + 800 * x[0] * x[0]; });
  const EquationOfState eos{kSound, true, Tension::full};
  b.set_excess(eos, [](const Vec3&) { return 0.0; });
  AcousticPass pass = pass_of(eos);
  pass.diffusion = {DiffusionForm::antuono, 0.1};
  // Round-off of rho - rho_0(T) is 1e-12 kg/m^3; the profile itself spans 700.
  for (double r : b.density_rate(pass)) CHECK(std::abs(r) < 1e-8);
}

TEST_CASE("pressure of walls continues that of a tank at rest") {
  const double g = 9;
  StageSetup b(2, 0.1);
  const Vec3 min = Vec3::Zero(), max(1, 1, 0);
  b.fill(min, max, 2000);
  b.dummies(4, min, max, 2000, 0.3);
  b.particles.density.assign(b.particles.size(), b.constants.density);
  b.prepare(Vec3::Constant(-0.6), Vec3::Constant(1.6));
  const double c = 4000;  // stiff: the density is uniform to 1e-6
  const EquationOfState eos{c, false, Tension::full, g};
  const auto pressure = [&](Index i) { return 7000 * g * (1 - b.patch.x[1][i]); };
  for (Index i = 0; i < b.patch.size(); ++i) b.patch.density[i] = 7000 + pressure(i) / (c * c);
  AcousticPass pass = pass_of(eos);
  pass.find_pairs(b.stage, 0, {});
  eos.update(b.stage);
  pass.gather(b.stage);
  int walls = 0;
  for (Index i = 0; i < b.patch.size(); ++i) {
    if (!b.patch.wall[i] || b.patch.x[1][i] < -0.2) continue;
    if (b.patch.x[0][i] < 0 || b.patch.x[0][i] > 1) continue;
    CHECK(b.patch.pressure[i] == Approx(pressure(i)).epsilon(1e-5));
    ++walls;
  }
  CHECK(walls == 20);
}
