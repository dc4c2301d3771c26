// SPDX-License-Identifier: MIT
#include "meltray/terms/stage.hpp"

#include <catch2/catch.hpp>

#include "unit/terms/stage_setup.hpp"

using namespace meltray;
using meltray::test::StageSetup;

namespace {

constexpr double kDx = 5e-5;

/// Lattice ball (or disc) of `cells` spacings radius around the origin.
void fill_ball(StageSetup& s, double cells) {
  const double r = cells * kDx, box = std::ceil(cells + 2) * kDx;
  s.for_lattice(Vec3::Constant(-box), Vec3::Constant(box), [&](const Vec3& x) {
    if ((s.constants.dim == 3 ? x.norm() : x.head<2>().norm()) < r) s.add(x, 2000, true);
  });
  s.prepare(Vec3::Constant(-box), Vec3::Constant(box));
}

}  // namespace

TEST_CASE("free surface: a flat face is one layer with exact normal and area") {
  for (auto kernel : {sph::KernelType::wendland_c2, sph::KernelType::cubic_spline})
    for (int dim : {2, 3}) {
      CAPTURE(dim, static_cast<int>(kernel));
      StageSetup s(dim, kDx, test::plain_metal(), kernel);
      const int up = dim - 1;
      Vec3 max = Vec3::Constant(12 * kDx);
      s.fill(Vec3::Zero(), max, 2000);
      Vec3 roof = max;
      roof[up] += 4 * kDx;
      s.prepare(Vec3::Zero(), roof, {true, dim == 3, false});
      double worst = 0, area = 0;
      for (Index i = 0; i < s.patch.size(); ++i) {
        const double z = s.patch.x[up][i];
        const bool top = z > 11 * kDx, bottom = z < kDx;
        worst = std::max(worst, std::abs(s.stage.surface[i] - (top || bottom ? 1.0 : 0.0)));
        Vec3 n = Vec3::Zero();
        n[up] = top ? 1 : bottom ? -1 : 0;
        worst = std::max(worst, (s.vector(s.stage.normal, i) - n).norm());
        worst = std::max(worst, std::abs(s.stage.area[i] / s.stage.area_of_spacing() - std::abs(n[up])));
        if (top) worst = std::max(worst, s.stage.grad_c[up][i] > 0 ? 1.0 : 0.0);  // points into the material
        area += top ? s.stage.area[i] : 0;
        worst = std::max(worst, static_cast<double>(s.stage.loose[i]));
      }
      CHECK(worst < 1e-7);  // pairs are stored in single precision
      CHECK(area == Approx(std::pow(12 * kDx, dim - 1)));
    }
}

TEST_CASE("free surface: inside a full lattice the sums are those of the lattice") {
  StageSetup s(3, kDx);
  s.fill(Vec3::Zero(), Vec3::Constant(9 * kDx), 2000);
  s.prepare(Vec3::Zero(), Vec3::Constant(9 * kDx), {true, true, true});
  for (Index i = 0; i < s.patch.size(); i += 37) {
    CHECK(s.stage.fill[i] == Approx(1));
    CHECK(s.stage.diagonal[i] == Approx(1));
    CHECK(s.stage.surface[i] == 0);
    CHECK(s.stage.volume[i] == Approx(kDx * kDx * kDx));
  }
}

TEST_CASE("free surface: edges and corners of a block point outwards along the diagonals") {
  StageSetup s(3, kDx);
  s.fill(Vec3::Zero(), Vec3::Constant(10 * kDx), 2000);
  s.prepare(Vec3::Constant(-3 * kDx), Vec3::Constant(13 * kDx));
  int corners = 0, edges = 0, wrong = 0;
  for (Index i = 0; i < s.patch.size(); ++i) {
    Vec3 outward = Vec3::Zero();
    int layer = 10;  // depth below the nearest face, in layers
    for (int c = 0; c < 3; ++c) {
      const double x = s.patch.x[c][i] / kDx;
      if (x < 1) outward[c] = -1;
      if (x > 9) outward[c] = 1;
      layer = std::min({layer, static_cast<int>(x), 9 - static_cast<int>(x)});
    }
    const int faces = static_cast<int>(outward.cwiseAbs().sum());
    corners += faces == 3;
    edges += faces == 2;
    wrong += faces > 0 && s.stage.surface[i] != 1;
    wrong += layer > 1 && s.stage.surface[i] != 0;
    const Vec3 n = s.vector(s.stage.normal, i);
    if (faces == 3) wrong += (n - outward.normalized()).norm() > 1e-9;
    // Near its ends an edge feels the corner: only the middle is exact.
    const Vec3 x = s.position(i) / kDx;
    const bool middle = ((x.array() < 1) || (x.array() > 9) || ((x.array() > 3) && (x.array() < 7))).all();
    if (faces == 2 && middle) wrong += (n - outward.normalized()).norm() > 1e-9;
  }
  CHECK(corners == 8);
  CHECK(edges == 12 * 8);
  CHECK(wrong == 0);
}

TEST_CASE("free surface: a ball has a closed shell with radial normals, a disc the length of the circle") {
  for (int dim : {2, 3})
    for (double cells : {10.0, 15.0}) {
      CAPTURE(dim, cells);
      StageSetup s(dim, kDx);
      fill_ball(s, cells);
      int missed = 0, inner = 0, shell = 0;
      double area = 0, tilt2 = 0;
      for (Index i = 0; i < s.patch.size(); ++i) {
        const Vec3 x = s.position(i);
        const double depth = cells - x.norm() / kDx;
        missed += depth < 0.5 && s.stage.surface[i] < 0.5;
        inner += depth > 2 && s.stage.surface[i] > 0;
        area += s.stage.area[i];
        if (s.stage.surface[i] < 0.5) continue;
        ++shell;
        tilt2 += 1 - std::pow(s.vector(s.stage.normal, i).dot(x.normalized()), 2);
      }
      CHECK(missed == 0);
      CHECK(inner == 0);
      // A shell cut out of a lattice is a staircase; its steps tilt normals by up to half a spacing over the
      // support of 2.6 spacings, 0.2 rad.
      CHECK(std::sqrt(tilt2 / shell) < 0.2);
      const double r = cells * kDx;
      if (dim == 2) CHECK(area == Approx(2 * M_PI * r).epsilon(0.10));
    }
}

// Exact is 1. A face along the lattice has exactly its area; the steps of a ball cut from it add to that of
// the sphere.
TEST_CASE("free surface: the area of a ball is that of the sphere, a seventh too large on a lattice") {
  StageSetup s(3, kDx);
  fill_ball(s, 15);
  double area = 0;
  for (double a : s.stage.area) area += a;
  CHECK(area / (4 * M_PI * std::pow(15 * kDx, 2)) == Approx(1.14).margin(0.03));
}

TEST_CASE("free surface: the weight changes continuously while a particle sinks into the surface") {
  double last = 1, last_area = 0, jump = 0, area_jump = 0;
  for (int k = 0; k <= 450; ++k) {
    StageSetup s(3, kDx);
    s.fill(Vec3::Zero(), Vec3(9 * kDx, 9 * kDx, 6 * kDx), 2000);
    // Above a hollow of the lattice, a hundredth of a spacing lower each time.
    const double z = (8.5 - 0.01 * k) * kDx;
    s.add(Vec3(4 * kDx, 4 * kDx, z), 2000, true);
    s.prepare(Vec3::Zero(), Vec3(9 * kDx, 9 * kDx, 12 * kDx), {true, true, false});
    Index moved = 0;
    while (s.patch.global[moved] + 1 != static_cast<Index>(s.particles.size())) ++moved;
    const double weight = s.stage.surface[moved], area = s.stage.area[moved] / (kDx * kDx);
    if (k > 0) {
      jump = std::max(jump, std::abs(weight - last));
      area_jump = std::max(area_jump, std::abs(area - last_area));
    }
    last = weight;
    last_area = area;
    if (k == 0) CHECK(weight == 1);
  }
  CHECK(last == 0);
  // The ramp is 0.08 of the fill wide, which rises by less than 0.008 in a hundredth of a spacing.
  CHECK(jump < 0.15);
  CHECK(area_jump < 0.15);
}

TEST_CASE("free surface: loose particles and dummies") {
  StageSetup s(3, kDx);
  const Vec3 max = Vec3::Constant(9 * kDx);
  s.fill(Vec3::Zero(), max, 2000);
  s.dummies(4, Vec3::Zero(), max, 300);
  s.add(Vec3(4.5 * kDx, 4.5 * kDx, 14.5 * kDx), 2000, true);
  s.add(Vec3(2.5 * kDx, 4.5 * kDx, 14.5 * kDx), 2000, true);
  s.prepare(Vec3(0, 0, -3 * kDx), Vec3(9 * kDx, 9 * kDx, 18 * kDx), {true, true, false});
  int loose = 0, wrong = 0;
  for (Index i = 0; i < s.patch.size(); ++i) {
    loose += s.stage.loose[i];
    // Material on a wall is not a free surface, nor is the outer end of the dummies.
    if (s.patch.wall[i] || (s.patch.x[2][i] < 8 * kDx)) wrong += s.stage.surface[i] != 0;
  }
  CHECK(loose == 2);
  CHECK(wrong == 0);
}

TEST_CASE("free surface: weights found piece by piece are those of a list") {
  const int dim = GENERATE(2, 3);
  CAPTURE(dim);
  StageSetup s(dim, kDx, test::plain_metal(), sph::KernelType::wendland_c2);
  const Vec3 min = Vec3::Zero(), max = Vec3::Constant((dim == 3 ? 20 : 80) * kDx);
  const int up = dim - 1;
  s.for_lattice(min, max, [&](const Vec3& x) {
    // A pool on solid with a deep solid below, of which the weights are not asked for.
    s.add(x, x[up] > 0.5 * max[up] ? 2000 : 300, x[up] > 0.5 * max[up]);
  });
  s.dummies(0, min, max, 300);
  s.jitter(0.2);
  Vec3 low = min, roof = max;
  low[0] -= 3 * kDx;
  roof[up] += 4 * kDx;
  s.prepare(low, roof);
  REQUIRE(s.patch.size() > 4000);  // several pieces
  std::vector<double> weight;
  terms::find_surface_weights(s.stage, s.selector.grid(), weight);
  Index differ = 0, asleep = 0, shown = 0;
  for (Index i = 0; i < s.patch.size(); ++i) {
    const bool row = s.patch.liquid[i] || s.pairs.next_to_melt()[i];
    differ += row && !s.patch.wall[i] && weight[i] != Approx(s.stage.surface[i]).margin(1e-9);
    asleep += !row && weight[i] != 0;
    shown += weight[i] > 0.5;
  }
  CHECK(differ == 0);
  CHECK(asleep == 0);
  CHECK(shown > 50);
}
