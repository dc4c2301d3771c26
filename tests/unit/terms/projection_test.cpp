// SPDX-License-Identifier: MIT
#include "meltray/terms/pressure/projection.hpp"

#include <catch2/catch.hpp>

#include "meltray/terms/surface_forces.hpp"
#include "unit/terms/stage_setup.hpp"

using namespace meltray;
using meltray::test::StageSetup;
using terms::Projection;
using terms::ProjectionOptions;
using terms::SurfaceEntry;

namespace {

constexpr double kDx = 5e-5, kRho = 7000;
constexpr SurfaceEntry kEntries[] = {SurfaceEntry::csf, SurfaceEntry::pressure};

ProjectionOptions exact(SurfaceEntry entry = SurfaceEntry::csf) {
  return {entry, terms::PressureSolver::conjugate_gradients, 1e-11, 5000};
}

Components pressure_acceleration(const StageSetup& s, const Projection& p, SurfaceEntry entry) {
  Components a = s.zeros();
  p.add_acceleration(s.stage, entry, view(a));
  return a;
}

double rms(const std::vector<double>& v) {
  double sum = 0;
  for (double x : v) sum += x * x;
  return std::sqrt(sum / v.size());
}

/// Sum over liquid rows only, weighted alike: rows are liquid particles and their solid neighbours in patch
/// order.
double rms_liquid(const StageSetup& s, const std::vector<double>& v) {
  double sum = 0;
  std::size_t row = 0, n = 0;
  for (Index i = 0; i < s.patch.size(); ++i) {
    const bool liquid = s.patch.liquid[i];
    if (!liquid && !s.pairs.next_to_melt()[i]) continue;
    if (liquid && !s.stage.loose[i]) {
      sum += v[row] * v[row];
      ++n;
    }
    if (!s.stage.loose[i]) ++row;
  }
  REQUIRE(row == v.size());
  return std::sqrt(sum / n);
}

/// A 2-D periodic box of `cells` spacings a side.
void periodic_square(StageSetup& s, int cells) {
  const Vec3 max(cells * kDx, cells * kDx, 0);
  s.fill(Vec3::Zero(), max, 2000);
  s.prepare(Vec3::Zero(), max, {true, true, false});
}

/// Liquid of `width` x `depth` spacings in a tank of dummies, open at the top.
void tank(StageSetup& s, int width, int depth) {
  const Vec3 max(width * kDx, depth * kDx, 0);
  s.fill(Vec3::Zero(), max, 2000);
  s.dummies(0, Vec3::Zero(), max + Vec3(0, 3 * kDx, 0), 300);
  s.dummies(1, Vec3::Zero(), max + Vec3(0, 3 * kDx, 0), 300);
  s.dummies(4, Vec3::Zero(), max, 300, 3 * kDx);
  s.constants.faces[1].plane = max[0];
  s.prepare(Vec3(-3 * kDx, -3 * kDx, 0), max + Vec3(3 * kDx, 4 * kDx, 0));
}

}  // namespace

TEST_CASE("projection: a uniform surface pressure is an exact rest state of both entries") {
  for (SurfaceEntry entry : kEntries)
    for (int dim : {2, 3}) {
      CAPTURE(dim, static_cast<int>(entry));
      StageSetup s(dim, kDx);
      const double box = 9 * kDx;
      // A jittered drop of no symmetry, a part of it solid.
      s.for_lattice(Vec3::Constant(-box), Vec3::Constant(box), [&](const Vec3& x) {
        const double r = (dim == 3 ? x.norm() : x.head<2>().norm()) / kDx;
        if (r < 6 || (x[0] > 0 && r < 7)) s.add(x, 2000, x[dim - 1] > -3 * kDx);
      });
      s.jitter(0.2);
      s.prepare(Vec3::Constant(-box), Vec3::Constant(box));
      const double q = 2e4;
      std::fill(s.stage.surface_pressure.begin(), s.stage.surface_pressure.end(), q);
      Projection p;
      p.assemble(s.stage);
      CHECK(p.floating() == 0);
      const auto report = p.solve(s.stage, std::vector<double>(p.rows(), 0.0), exact(entry));
      CHECK(report.converged);
      double worst = 0, fastest = 0;
      const auto a = pressure_acceleration(s, p, entry);
      for (Index i : s.stage.moving) {
        if (s.stage.loose[i]) continue;
        worst = std::max(worst, std::abs(s.patch.pressure[i] - q));
        fastest = std::max(fastest, s.vector(a, i).norm());
      }
      CHECK(worst < 1e-8 * q);
      CHECK(fastest < 1e-7 * q / (kRho * kDx));
    }
}

namespace {

/// Solves for the pressure of liquid under gravity; the largest error of rho g depth over rho g times the
/// depth.
double hydrostatic_error(StageSetup& s, SurfaceEntry entry, double depth, Components& acceleration) {
  const double g = 9.81;
  Components force = s.zeros();
  for (Index i : s.stage.moving) force[1][i] = -g;
  Projection p;
  p.assemble(s.stage);
  std::vector<double> source;
  p.divergence(s.stage, view(std::as_const(force)), source);
  CHECK(p.solve(s.stage, source, exact(entry)).converged);
  acceleration = pressure_acceleration(s, p, entry);
  double worst = 0;
  for (Index i : s.stage.moving)
    worst = std::max(worst, std::abs(s.patch.pressure[i] - kRho * g * (depth - s.patch.x[1][i])));
  return worst / (kRho * g * depth);
}

}  // namespace

TEST_CASE("projection: hydrostatic pressure in a wide basin is rho g depth") {
  for (SurfaceEntry entry : kEntries) {
    CAPTURE(static_cast<int>(entry));
    StageSetup s(2, kDx);
    const Vec3 max(10 * kDx, 40 * kDx, 0);
    s.fill(Vec3::Zero(), max, 2000);
    s.dummies(4, Vec3::Zero(), max, 300);
    s.prepare(Vec3(0, -3 * kDx, 0), max + Vec3(0, 4 * kDx, 0), {true, false, false});
    Components a;
    // The ghost condition puts p = 0 a tenth of a spacing off the face: the second layer, too, lacks
    // neighbours beyond it.
    CHECK(hydrostatic_error(s, entry, max[1], a) < 0.15 / 40);
    int wrong = 0;
    for (Index i : s.stage.moving)
      if (s.patch.x[1][i] > 3 * kDx && s.patch.x[1][i] < 36 * kDx)
        wrong += std::abs(a[1][i] / 9.81 - 1) > 0.03;
    CHECK(wrong == 0);
  }
}

TEST_CASE(
    "projection: a pressure linear from the face inwards has an exact gradient in the outermost layer") {
  const int dim = GENERATE(2, 3);
  const int up = dim - 1;
  for (SurfaceEntry entry : kEntries) {
    CAPTURE(dim, static_cast<int>(entry));
    StageSetup s(dim, kDx);
    Vec3 max = Vec3::Constant(8 * kDx);
    if (dim == 2) max[2] = 0;
    s.fill(Vec3::Zero(), max, 2000);
    Vec3 above = Vec3::Zero();
    above[up] = 4 * kDx;
    std::array<bool, 3> periodic{true, dim == 3, false};
    s.prepare(Vec3::Zero(), max + above, periodic);
    Projection p;
    p.assemble(s.stage);
    const double slope = 9.81 * kRho;
    for (Index i = 0; i < s.patch.size(); ++i) s.patch.pressure[i] = slope * (max[up] - s.patch.x[up][i]);
    const Components a = pressure_acceleration(s, p, entry);
    int outermost = 0;
    for (Index i = 0; i < s.patch.size(); ++i) {
      const double depth = (max[up] - s.patch.x[up][i]) / kDx;
      if (depth > 4) continue;
      // The second layer lacks what is two spacings above it, 5 to 7 % of its gradient.
      const bool second = depth > 1 && depth < 2;
      CHECK(a[up][i] == Approx(9.81).epsilon(second ? 0.08 : 1e-6));
      outermost += depth < 1;
    }
    CHECK(outermost == (dim == 2 ? 8 : 64));
  }
}

TEST_CASE("projection: hydrostatic pressure in a narrow tank is rho g depth") {
  for (SurfaceEntry entry : kEntries) {
    StageSetup s(2, kDx);
    tank(s, 30, 24);
    Components a;
    // As in the basin, and more in the corners.
    CHECK(hydrostatic_error(s, entry, 24 * kDx, a) < 0.01);
  }
}

TEST_CASE("projection: a uniform force on a full box leaves nothing, corners and films included") {
  // A linear pressure solves every row exactly where the particles sit on their lattice; what is left is the
  // single precision of the matrix.
  for (const int across : {1, 2, 12}) {
    CAPTURE(across);
    StageSetup s(2, kDx);
    const Vec3 max(across * kDx, 12 * kDx, 0), edge(3 * kDx, 3 * kDx, 0);
    s.fill(Vec3::Zero(), max, 2000);
    for (const int side : {0, 1}) s.dummies(side, Vec3::Zero(), max, 300);
    for (const int end : {4, 5}) s.dummies(end, Vec3::Zero(), max, 300, 3 * kDx);
    s.constants.faces[1].plane = max[0];
    s.constants.faces[5].plane = max[1];
    s.constants.free_surface = false;
    s.prepare(-edge, max + edge);
    Components force = s.zeros();
    for (Index i : s.stage.moving) force[1][i] = -9.81;
    Projection p;
    p.assemble(s.stage);
    std::vector<double> source;
    p.divergence(s.stage, view(std::as_const(force)), source);
    CHECK(p.solve(s.stage, source, exact()).converged);
    const Components a = pressure_acceleration(s, p, SurfaceEntry::csf);
    for (Index i : s.stage.moving) {
      CHECK(std::abs(a[0][i]) < 1e-4 * 9.81);
      CHECK(std::abs(a[1][i] - 9.81) < 1e-4 * 9.81);
    }
  }
}

TEST_CASE("projection: a step removes most of the divergence") {
  for (SurfaceEntry entry : kEntries) {
    CAPTURE(static_cast<int>(entry));
    StageSetup s(2, kDx);
    tank(s, 30, 24);
    // Compression towards the middle of the tank, smooth on the scale of the support, zero at the walls.
    const double k = M_PI / (30 * kDx), m = M_PI / (24 * kDx);
    s.set_velocity([&](const Vec3& x) -> Vec3 {
      return Vec3(std::sin(2 * k * x[0]) * std::sin(m * x[1]),
                  0.5 * std::sin(k * x[0]) * std::sin(2 * m * x[1]), 0);
    });
    for (Index i = 0; i < s.patch.size(); ++i)
      if (s.patch.wall[i]) s.patch.v[0][i] = s.patch.v[1][i] = 0;
    const double dt = 1e-6;
    Projection p;
    p.assemble(s.stage);
    std::vector<double> before, source, after;
    p.divergence(s.stage, s.velocity(), before);
    source = before;
    for (double& x : source) x /= dt;
    p.solve(s.stage, source, exact(entry));
    const auto a = pressure_acceleration(s, p, entry);
    for (Index i : s.stage.moving)
      for (int c = 0; c < 2; ++c) s.patch.v[c][i] += dt * a[c][i];
    p.divergence(s.stage, s.velocity(), after);
    // The Laplacian is not the product of divergence and gradient: what remains is of the order (h k)^2.
    INFO("divergence left: " << rms_liquid(s, after) / rms_liquid(s, before));
    CHECK(rms_liquid(s, after) < 0.25 * rms_liquid(s, before));
  }
}

namespace {

/// Largest error of the pressure of a Taylor-Green vortex over rho/2, from the source of the `stage`
/// projection. v = (sin kx cos ky, -cos kx sin ky): p = rho/4 (cos 2kx + cos 2ky).
double taylor_green_error(double smoothing_ratio) {
  StageSetup s(2, kDx);
  s.constants.smoothing = smoothing_ratio * kDx;
  s.constants.lattice = sph::lattice_sums(s.constants.kernel, 2, kDx, s.constants.smoothing);
  const int cells = 64;
  periodic_square(s, cells);
  const double k = 2 * M_PI / (cells * kDx);
  s.set_velocity([&](const Vec3& x) {
    return Vec3(std::sin(k * x[0]) * std::cos(k * x[1]), -std::cos(k * x[0]) * std::sin(k * x[1]), 0);
  });
  Projection p;
  p.assemble(s.stage);
  CHECK(p.floating() == 1);
  std::vector<double> source, divergence;
  p.divergence(s.stage, s.velocity(), divergence);
  CHECK(rms(divergence) < 1e-9 * k);
  p.divergence_rate(s.stage, s.velocity(), source);
  CHECK(p.solve(s.stage, source, exact()).converged);
  double worst = 0, mean = 0;
  for (Index i = 0; i < s.patch.size(); ++i) {
    const double x = s.patch.x[0][i], z = s.patch.x[1][i];
    const double expected = kRho / 4 * (std::cos(2 * k * x) + std::cos(2 * k * z));
    worst = std::max(worst, std::abs(s.patch.pressure[i] - expected));
    mean += s.patch.pressure[i] / s.patch.size();
  }
  CHECK(std::abs(mean) < 1e-10 * kRho);
  return worst / (kRho / 2);
}

}  // namespace

// The source is smoothed over the kernel, so a wider one costs accuracy; 2 % is the line for the weld's h
// = 1.3 dx.
TEST_CASE("projection: the stage source of a Taylor-Green vortex gives its pressure") {
  for (double ratio : {1.3, 1.5, 2.0}) {
    CAPTURE(ratio);
    CHECK(taylor_green_error(ratio) < 0.02);
  }
}

TEST_CASE("projection: a linear velocity field v = A x has the source -tr(A^2), also out of order") {
  for (auto kernel : {sph::KernelType::wendland_c2, sph::KernelType::cubic_spline}) {
    StageSetup s(3, kDx, test::plain_metal(), kernel);
    const Vec3 max = Vec3::Constant(8 * kDx);
    s.fill(Vec3::Zero(), max, 2000);
    s.jitter(0.2);
    s.prepare(Vec3::Constant(-kDx), max + Vec3::Constant(kDx));
    test::Noise noise(3);
    Eigen::Matrix3d a;
    for (int i = 0; i < 9; ++i) a(i / 3, i % 3) = 1e4 * noise();
    s.set_velocity([&](const Vec3& x) { return Vec3(a * x); });
    Projection p;
    p.assemble(s.stage);
    std::vector<double> rate;
    p.divergence_rate(s.stage, s.velocity(), rate);
    double worst = 0;
    int inside = 0;
    for (Index i = 0; i < s.patch.size(); ++i) {
      // Corners of the block are thin enough for the ridge of the renormalisation to act.
      if ((s.position(i) - 0.5 * max).cwiseAbs().maxCoeff() > 3 * kDx) continue;
      ++inside;
      worst = std::max(worst, std::abs(rate[i] + (a * a).trace()));
    }
    CHECK(inside > 100);
    CHECK(worst < 1e-7 * a.squaredNorm());  // pairs are stored in single precision
  }
}

TEST_CASE("projection: rigid rotation keeps its shape: source 2 omega^2 and a parabola of pressure") {
  StageSetup s(2, kDx);
  const double cells = 24, box = 27 * kDx, omega = 4000;
  s.for_lattice(Vec3::Constant(-box), Vec3::Constant(box), [&](const Vec3& x) {
    if (x.head<2>().norm() < cells * kDx) s.add(x, 2000, true);
  });
  s.prepare(Vec3::Constant(-box), Vec3::Constant(box));
  const double r2 = s.cell_volume() * s.patch.size() / M_PI;
  s.set_velocity([&](const Vec3& x) { return Vec3(-omega * x[1], omega * x[0], 0); });
  for (SurfaceEntry entry : kEntries) {
    CAPTURE(static_cast<int>(entry));
    Projection p;
    p.assemble(s.stage);
    std::vector<double> source;
    p.divergence_rate(s.stage, s.velocity(), source);
    int wrong = 0;
    for (Index i = 0; i < s.patch.size(); ++i)
      if (s.position(i).norm() < (cells - 4) * kDx)
        wrong += std::abs(source[i] / (2 * omega * omega) - 1) > 1e-6;  // pairs in single precision
    CHECK(wrong == 0);
    CHECK(p.solve(s.stage, source, exact(entry)).converged);
    const double depth = 0.5 * kRho * omega * omega * r2;  // p = -rho omega^2 (R^2 - r^2)/2
    double worst = 0;
    for (Index i = 0; i < s.patch.size(); ++i) {
      const double expected = -depth * (1 - s.position(i).squaredNorm() / r2);
      worst = std::max(worst, std::abs(s.patch.pressure[i] - expected) / depth);
    }
    // The rim of a disc cut from a lattice is certain to half a spacing: dx/R of the depth.
    CHECK(worst < 1 / cells);
  }
}

// Exact is 1. On a lattice the mean curvature is too large (see surface_tension_test), and the pressure
// inside is the mean over the surface that the projection makes of it.
TEST_CASE("projection: surface tension gives a drop its Laplace pressure, 6 to 7 % too high on a lattice") {
  for (SurfaceEntry entry : kEntries)
    for (int dim : {2, 3}) {
      StageSetup s(dim, kDx);
      const double cells = dim == 3 ? 10 : 20, box = (cells + 3) * kDx;
      s.for_lattice(Vec3::Constant(-box), Vec3::Constant(box), [&](const Vec3& x) {
        if ((dim == 3 ? x.norm() : x.head<2>().norm()) < cells * kDx) s.add(x, 2000, true);
      });
      s.prepare(Vec3::Constant(-box), Vec3::Constant(box));
      const double volume = s.cell_volume() * s.patch.size();
      const double r = dim == 3 ? std::cbrt(0.75 * volume / M_PI) : std::sqrt(volume / M_PI);
      std::vector<double> q;
      terms::SurfaceTension tension;
      tension.ramp = 0;
      tension.pressure(s.stage, q);
      terms::average_over_surface(s.stage, q, s.stage.surface_pressure);
      Projection p;
      p.assemble(s.stage);
      CHECK(p.solve(s.stage, std::vector<double>(p.rows(), 0.0), exact(entry)).converged);
      double inside = 0;
      int n = 0;
      for (Index i = 0; i < s.patch.size(); ++i) {
        if (s.position(i).norm() > 0.5 * r) continue;
        inside += s.patch.pressure[i];
        ++n;
      }
      CAPTURE(dim, static_cast<int>(entry));
      const double laplace = (dim - 1) * 1.8 / r;
      CHECK(inside / n / laplace == Approx(dim == 2 ? 1.06 : 1.07).margin(0.02));
    }
}

TEST_CASE("projection: a closed box has mean-zero pressure, pockets are projected one by one") {
  StageSetup s(2, kDx);
  // Two closed pockets of liquid in solid, too far apart to share a wall.
  s.for_lattice(Vec3::Zero(), Vec3(50 * kDx, 20 * kDx, 0), [&](const Vec3& x) {
    const Vec3 c = x / kDx;
    const bool left = c[0] > 6 && c[0] < 16 && c[1] > 6 && c[1] < 14;
    const bool right = c[0] > 32 && c[0] < 44 && c[1] > 6 && c[1] < 14;
    s.add(x, 2000, left || right);
  });
  s.prepare(Vec3::Zero(), Vec3(50 * kDx, 20 * kDx, 0), {true, true, false});
  Components force = s.zeros();
  for (Index i : s.stage.moving) force[1][i] = -9.81;
  Projection p;
  p.assemble(s.stage);
  CHECK(p.floating() == 2);
  std::vector<double> source;
  p.divergence(s.stage, view(std::as_const(force)), source);
  CHECK(p.solve(s.stage, source, exact()).converged);
  double sum[2] = {}, low = 0, high = 0;
  for (Index i = 0; i < s.patch.size(); ++i) {
    sum[s.patch.x[0][i] > 25 * kDx] += s.patch.pressure[i];
    low = std::min(low, s.patch.pressure[i]);
    high = std::max(high, s.patch.pressure[i]);
  }
  CHECK(high > 0);
  for (double m : sum) CHECK(std::abs(m) < 1e-8 * (high - low) * p.rows());
  // Hydrostatic between the outer walls: rho g times the height of the pocket, 8 spacings, within a wall
  // layer.
  CHECK(high - low > kRho * 9.81 * 7 * kDx);
  CHECK(high - low < kRho * 9.81 * 13 * kDx);
  // Factors give the same, pockets included.
  const std::vector<double> iterated = s.patch.pressure;
  ProjectionOptions by_factors = exact();
  by_factors.solver = terms::PressureSolver::cholesky;
  const auto report = p.solve(s.stage, source, by_factors);
  CHECK(report.iterations == 0);
  CHECK(report.residual < 1e-10);
  for (Index i = 0; i < s.patch.size(); ++i)
    CHECK(std::abs(s.patch.pressure[i] - iterated[i]) < 1e-7 * (high - low));
}

TEST_CASE("projection: a free surface, by factors and by iterations") {
  StageSetup s(3, kDx);
  const Vec3 max(8 * kDx, 8 * kDx, 6 * kDx);
  s.fill(Vec3::Zero(), max, 2000);
  s.jitter(0.1);
  s.prepare(Vec3::Constant(-2 * kDx), max + Vec3::Constant(2 * kDx));
  Components force = s.zeros();
  for (Index i : s.stage.moving) force[2][i] = -9.81 * (1 + s.patch.x[0][i] / kDx);
  for (Index i : s.stage.moving) s.stage.surface_pressure[i] = 1e3 * s.patch.x[1][i] / kDx;
  Projection p;
  p.assemble(s.stage);
  std::vector<double> source;
  p.divergence(s.stage, view(std::as_const(force)), source);
  CHECK(p.solve(s.stage, source, exact()).converged);
  const std::vector<double> iterated = s.patch.pressure;
  ProjectionOptions by_factors = exact();
  by_factors.solver = terms::PressureSolver::cholesky;
  CHECK(p.solve(s.stage, source, by_factors).residual < 1e-10);
  double largest = 0;
  for (double x : iterated) largest = std::max(largest, std::abs(x));
  REQUIRE(largest > 0);
  for (Index i = 0; i < s.patch.size(); ++i)
    CHECK(std::abs(s.patch.pressure[i] - iterated[i]) < 1e-7 * largest);
}

TEST_CASE(
    "projection: loose particles take no part, density errors near a surface count as compression only") {
  StageSetup s(3, kDx);
  s.fill(Vec3::Zero(), Vec3::Constant(9 * kDx), 2000);
  s.add(Vec3(4.5 * kDx, 4.5 * kDx, 14.5 * kDx), 2000, true);
  s.prepare(Vec3::Zero(), Vec3(9 * kDx, 9 * kDx, 17 * kDx), {true, true, false});
  Projection p;
  p.assemble(s.stage);
  CHECK(p.rows() == s.patch.size() - 1);
  std::vector<double> compression;
  p.compression(s.stage, compression);
  for (double c : compression) CHECK(std::abs(c) < 5e-3);
  p.solve(s.stage, std::vector<double>(p.rows(), 1e8), exact());
  const auto a = pressure_acceleration(s, p, SurfaceEntry::pressure);
  for (Index i = 0; i < s.patch.size(); ++i)
    if (s.stage.loose[i]) CHECK((s.vector(a, i).norm() == 0 && s.patch.pressure[i] == 0));
}
