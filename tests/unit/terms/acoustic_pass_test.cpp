// SPDX-License-Identifier: MIT
// The pass over clusters against a plain double loop over all pairs.
#include "meltray/terms/pressure/acoustic_pass.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "meltray/sph/renormalise.hpp"
#include "unit/terms/stage_setup.hpp"

using namespace meltray;
using namespace meltray::terms;
using meltray::test::StageSetup;

namespace {

/// A rotated, jittered pool of melt on solid, with a slip wall and velocities, or periodic melt.
struct Pool : StageSetup {
  std::array<double, 3> period{};
  Pool(int dim, sph::KernelType kernel, bool periodic) : StageSetup(dim, 0.1, test::plain_metal(), kernel) {
    if (periodic) {
      fill(Vec3::Zero(), Vec3(1, 1, dim == 3 ? 1 : 0), 2000);
      for (int c = 0; c < dim; ++c) period[c] = 1;
    } else {
      const Eigen::Matrix3d turn =
          (Eigen::AngleAxisd(0.3, Vec3::UnitZ()) * Eigen::AngleAxisd(dim == 3 ? 0.5 : 0.0, Vec3::UnitX()))
              .toRotationMatrix();
      const Vec3 size(0.9, 0.9, dim == 3 ? 0.7 : 0);
      for_lattice(Vec3::Zero(), size, [&](const Vec3& x) { add(turn * x, 2000, x[dim - 1] > 0.3); });
      dummies(1, Vec3(0, 0, 0), Vec3(0.9, 0.9, dim == 3 ? 0.7 : 0), 2000);
      constants.faces[1].no_slip = false;
    }
    jitter(0.3);
    particles.density.assign(particles.size(), constants.density);
    const double reach = periodic ? 0 : 0.8;
    prepare(Vec3::Constant(-reach), Vec3::Constant(1 + 1.2 * reach),
            {periodic, periodic, periodic && dim == 3});
    test::Noise noise(3);
    for (Index i = 0; i < patch.size(); ++i) {
      if (patch.liquid[i]) patch.density[i] *= 1 + 0.02 * noise();
      for (int c = 0; c < dim; ++c) patch.v[c][i] = noise();
    }
  }
  Vec3 separation(Index i, Index j) const {
    Vec3 d = position(i) - position(j);
    for (int c = 0; c < constants.dim; ++c)
      if (period[c] > 0) d[c] -= period[c] * std::rint(d[c] / period[c]);
    return d;
  }
};

struct Sums {
  double rate = 0;
  Vec3 force = Vec3::Zero();  ///< over the mass
};

/// The equations of weakly_compressible.hpp, pair by pair.
template <int D, class Kernel>
std::vector<Sums> plain_sums(const Pool& b, const AcousticPass& pass) {
  const Index n = b.patch.size();
  const double h = b.constants.smoothing, moment = b.constants.lattice.second_moment,
               c = pass.state.sound_speed;
  const auto f = [&](double r) { return Kernel::f(r, 1 / h); };
  const auto w = [&](double r) { return Kernel::w(r, 1 / h); };
  const bool antuono = pass.diffusion.form == DiffusionForm::antuono;
  std::vector<double> p = b.patch.pressure;
  for (Index i = 0; i < n; ++i) {
    if (b.patch.liquid[i]) continue;
    double above = 0, below = 0;
    for (Index j = 0; j < n; ++j)
      if (b.patch.liquid[j]) {
        const Vec3 d = b.separation(i, j);
        above += w(d.norm()) * (p[j] - b.patch.density[j] * pass.state.gravity * d[D - 1]);
        below += w(d.norm());
      }
    p[i] = below > 0 ? above / below : 0;
    if (pass.state.tension == Tension::none) p[i] = std::max(p[i], 0.0);
  }
  std::vector<Vec3> gradient(n, Vec3::Zero());
  for (Index i = 0; i < n && antuono; ++i) {
    if (!b.patch.liquid[i]) continue;
    Eigen::Matrix<double, D, D> m = Eigen::Matrix<double, D, D>::Zero();
    Eigen::Matrix<double, D, 1> g = Eigen::Matrix<double, D, 1>::Zero();
    for (Index j = 0; j < n; ++j) {
      if (!b.patch.liquid[j] || j == i) continue;
      const Eigen::Matrix<double, D, 1> d = b.separation(i, j).template head<D>();
      const double vf = b.stage.volume[j] * f(d.norm());
      g += vf * (b.stage.excess[j] - b.stage.excess[i]) * d;
      m -= vf * d * d.transpose();
    }
    gradient[i].template head<D>() = sph::renormalisation<D>(m) * g;
  }
  std::vector<Sums> all(n);
  for (Index i = 0; i < n; ++i) {
    if (!b.patch.liquid[i]) continue;
    Sums& s = all[i];
    for (Index j = 0; j < n; ++j) {
      const Vec3 d = b.separation(i, j);
      const double r = d.norm();
      if (j == i || r > 2 * h) continue;
      const double vf = b.stage.volume[j] * f(r),
                   along = (b.vector(b.patch.v, i) - b.vector(b.patch.v, j)).dot(d);
      s.rate += b.patch.density[i] / moment * vf * along;
      if (b.patch.liquid[j])
        s.rate -= pass.diffusion.coefficient * h * c / moment * vf *
                  (2 * (b.stage.excess[j] - b.stage.excess[i]) + (gradient[i] + gradient[j]).dot(d));
      const bool sum = pass.force.form == GradientForm::sum;
      double pair = sum ? p[i] + p[j] : p[j] - p[i];
      if (pass.state.tension == Tension::artificial_stress) {
        const double ratio = w(r) / w(b.constants.spacing), pull = std::min(p[i], 0.0) + std::min(p[j], 0.0);
        pair += std::pow(ratio, 4) * (pull < 0 ? -0.2 * pull : sum ? 0.01 * (p[i] + p[j]) : 0.0);
      }
      s.force -= b.stage.volume[i] / b.patch.mass[i] / moment * vf * pair * d;
      const int wall = b.patch.wall[j];
      if (along < 0 && !(wall && !b.constants.faces[wall - 1].no_slip))
        s.force += b.patch.mass[j] * pass.artificial.alpha * c * h * along * f(r) /
                   (0.5 * (b.patch.density[i] + b.patch.density[j]) * (r * r + 0.01 * h * h)) * d;
    }
  }
  return all;
}

template <int D>
void compare(sph::KernelType kernel, bool periodic, const AcousticPass& terms) {
  Pool b(D, kernel, periodic);
  AcousticPass pass = terms;
  b.evaluate(pass);
  std::vector<double> rate(b.patch.size(), 0.0);
  Components force = b.zeros();
  pass.add_rates(b.stage, rate.data(), view(force));
  const auto expected = kernel == sph::KernelType::wendland_c2 ? plain_sums<D, sph::WendlandC2<D>>(b, pass)
                                                               : plain_sums<D, sph::CubicSpline<D>>(b, pass);
  Sums most;
  for (const Sums& s : expected) {
    most.rate = std::max(most.rate, std::abs(s.rate));
    most.force = most.force.cwiseMax(s.force.cwiseAbs());
  }
  REQUIRE(most.rate > 0);
  for (Index i = 0; i < b.patch.size(); ++i) {
    if (b.stage.loose[i]) continue;
    REQUIRE(std::abs(rate[i] - expected[i].rate) < 1e-11 * most.rate);
    REQUIRE((b.vector(force, i) - expected[i].force).norm() < 1e-11 * most.force.norm());
  }
}

}  // namespace

TEST_CASE("acoustic pass: all sums are those of a plain loop over pairs", "[acoustic]") {
  const auto kernel = GENERATE(sph::KernelType::wendland_c2, sph::KernelType::cubic_spline);
  const bool periodic = GENERATE(false, true);
  const auto tension = GENERATE(Tension::full, Tension::none, Tension::artificial_stress);
  AcousticPass pass;
  pass.state = {40, false, tension, 9.81};
  pass.artificial.alpha = GENERATE(0.0, 3.0);  // the latter as strong as the pressure
  SECTION("difference form, Antuono's diffusion") {
    pass.diffusion = {DiffusionForm::antuono, 0.1};
    pass.force.form = GradientForm::difference;
  }
  SECTION("sum form, diffusion of Molteni and Colagrossi") {
    pass.diffusion = {DiffusionForm::molteni_colagrossi, 0.1};
    pass.force.form = GradientForm::sum;
  }
  compare<2>(kernel, periodic, pass);
  compare<3>(kernel, periodic, pass);
}

TEST_CASE("acoustic pass: terms that are off add nothing", "[acoustic]") {
  Pool b(3, sph::KernelType::wendland_c2, false);
  AcousticPass pass;
  pass.state.sound_speed = 40;
  b.evaluate(pass);
  // At the density of rest there is no pressure, and without artificial viscosity no force.
  Pool still(3, sph::KernelType::wendland_c2, false);
  still.patch.density.assign(still.patch.size(), still.constants.density);
  AcousticPass inviscid = pass;
  still.evaluate(inviscid);
  Components a = still.zeros();
  std::vector<double> unused(still.patch.size());
  inviscid.add_rates(still.stage, unused.data(), view(a));
  for (const auto& component : a)
    for (const double value : component) CHECK(value == 0);
  AcousticPass none = pass;
  none.diffusion = {DiffusionForm::antuono, 0};
  b.evaluate(none);
  std::vector<double> with(b.patch.size(), 0.0), without = with;
  Components force = b.zeros();
  pass.add_rates(b.stage, with.data(), view(force));
  none.add_rates(b.stage, without.data(), view(force));
  CHECK(with == without);
}
