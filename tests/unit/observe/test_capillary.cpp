// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "meltray/observe/capillary.hpp"
#include "meltray/observe/pool.hpp"

using namespace meltray;
using namespace meltray::observe;

namespace {

constexpr double kSpacing = 5e-5;

/// A plate 2 x 1.2 x 1.5 mm (top at z = 0) with a hole of radius 0.2 mm and the given depth at the origin,
/// lined with three layers of melt. Places in the hole and above the
/// plate are filled with melt where `extra` says so.
template <class Extra>
Particles plate(int dim, double hole_depth, Extra&& extra) {
  Particles p;
  p.dim = dim;
  const int nx = 40, ny = dim == 3 ? 24 : 1, nz = 30;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = -4; k < nz; ++k) {
        const double x = (i - nx / 2 + 0.5) * kSpacing;
        const double y = dim == 3 ? (j - ny / 2 + 0.5) * kSpacing : 0;
        const double z = -(k + 0.5) * kSpacing;
        const double r = std::hypot(x, y);
        const bool hole = z > 0 || (r < 2e-4 && z > -hole_depth);
        const bool melt = r < 3.5e-4 && z > -hole_depth - 1.5e-4;
        if (hole && !extra(Vec3(x, y, z))) continue;
        p.add(dim == 3 ? Vec3(x, y, z) : Vec3(x, z, 0), 1e5, 1e-9, 1.3 * kSpacing);
        p.temperature.back() = 300;
        p.phase.back() = melt || hole ? 1 : 0;
      }
  return p;
}

const auto kNothing = [](const Vec3&) { return false; };

VoidRegion region(const Particles& p) {
  const Pool pool = measure_pool(p, kSpacing, std::nullopt, 0);
  const Vec3 margin = Vec3::Constant(3 * kSpacing);
  VoidRegion r{pool.min - margin, pool.max + margin};
  r.max[2] = std::max(0.0, pool.max[2]) + 3 * kSpacing;
  return r;
}

}  // namespace

TEST_CASE("the void of an open hole is as deep as the hole", "[capillary]") {
  const int dim = GENERATE(2, 3);
  const double depth = GENERATE(3e-4, 6e-4, 1e-3);
  const Particles p = plate(dim, depth, kNothing);
  // The smoothed surface lies within a quarter of a spacing of the last layer's outer face.
  CHECK(void_depth(p, kSpacing, region(p)) == Approx(depth).margin(0.25 * kSpacing));
}

TEST_CASE("a flat melt has no capillary", "[capillary]") {
  const int dim = GENERATE(2, 3);
  const Particles p = plate(dim, 0, kNothing);
  CHECK(void_depth(p, kSpacing, region(p)) == Approx(0).margin(0.25 * kSpacing));
}

TEST_CASE("melt that bridges the hole closes it, a drop in flight does not", "[capillary]") {
  const double depth = 8e-4;
  SECTION("a lid of three layers over the whole hole") {
    const Particles p = plate(3, depth, [](const Vec3& x) {
      return std::hypot(x[0], x[1]) < 2e-4 && x[2] < -2e-4 && x[2] > -3.5e-4;
    });
    CHECK(void_depth(p, kSpacing, region(p)) == Approx(2e-4).margin(0.25 * kSpacing));
  }
  SECTION("a drop in the middle of the hole") {
    const Particles p = plate(3, depth, [](const Vec3& x) { return (x - Vec3(0, 0, -4e-4)).norm() < 1e-4; });
    CHECK(void_depth(p, kSpacing, region(p)) == Approx(depth).margin(0.25 * kSpacing));
  }
  SECTION("a loose disc that all but fills the hole") {
    // One spacing of gap to the lining: the flood does not pass it, but the disc hangs on nothing.
    const Particles p = plate(3, depth, [](const Vec3& x) {
      return std::hypot(x[0], x[1]) < 1e-4 && std::abs(x[2] + 4e-4) < 1e-4;
    });
    CHECK(void_depth(p, kSpacing, region(p)) == Approx(depth).margin(0.25 * kSpacing));
  }
}

TEST_CASE("closed means three spacings between void and axis depth", "[capillary]") {
  CHECK(capillary_closed(8e-4, 2e-4, kSpacing));
  CHECK_FALSE(capillary_closed(8e-4, 6.6e-4, kSpacing));
}

TEST_CASE("axis depth is the deepest first hit of the bundle", "[capillary]") {
  laser::BeamSpec spec;
  spec.power = 1000;
  const laser::Beam beam(spec);
  laser::Tracer tracer;
  tracer.set_mesh({});
  CHECK(axis_depth(tracer, beam, 0, kSpacing, 1e-3) == 0);

  laser::SurfaceMesh floor;
  const double z = -7e-4;
  floor.vertices = {Vec3(-1e-3, -1e-3, z), Vec3(1e-3, -1e-3, z), Vec3(1e-3, 1e-3, z), Vec3(-1e-3, 1e-3, z)};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  floor.normals.assign(4, Vec3(0, 0, 1));
  floor.liquid.assign(4, 1);
  laser::SurfaceMesh beside = floor;
  tracer.set_mesh(floor);
  CHECK(axis_depth(tracer, beam, 0, kSpacing, 1e-3) == Approx(7e-4).epsilon(1e-5));
  for (auto& v : beside.vertices) v[0] += 5e-3;
  tracer.set_mesh(beside);
  CHECK(axis_depth(tracer, beam, 0, kSpacing, 1e-3) == 1e-3);
}
