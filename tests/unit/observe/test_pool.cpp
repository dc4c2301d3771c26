// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "meltray/observe/pool.hpp"

using namespace meltray;
using namespace meltray::observe;

namespace {

constexpr double kSpacing = 1e-4;

/// Block of nx x ny x nz particles; its low corner (outer faces, not centres) at `corner`.
void block(Particles& p, const Vec3& corner, int nx, int ny, int nz, bool liquid, std::uint8_t flags = 0) {
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) {
        p.add(corner + kSpacing * Vec3(i + 0.5, j + 0.5, k + 0.5), 1e5, 1e-9, 1.3 * kSpacing);
        p.phase.back() = liquid ? 1 : 0;
        p.flags.back() |= flags;
      }
}

}  // namespace

TEST_CASE("the pool is the connected melt at the beam") {
  Particles p;
  block(p, Vec3(0, -3e-4, -5e-4), 12, 6, 5, true);      // pool 1.2 x 0.6 x 0.5 mm
  block(p, Vec3(3e-3, -5e-4, -9e-4), 12, 10, 9, true);  // larger, far away
  block(p, Vec3(5e-4, 0, 3e-4), 2, 2, 2, true);         // drop 0.3 mm above
  SECTION("near the beam") {
    const Pool pool = measure_pool(p, kSpacing, Vec3(6e-4, 0, 0), 2e-4);
    REQUIRE(pool.exists);
    CHECK(pool.particles == 12 * 6 * 5);
    CHECK(pool.length == Approx(1.2e-3));
    CHECK(pool.width == Approx(6e-4));
    CHECK(pool.depth == Approx(5e-4));
    CHECK(pool.top == Approx(0).margin(1e-12));
  }
  SECTION("the largest without a beam") {
    CHECK(measure_pool(p, kSpacing, std::nullopt, 0).particles == 12 * 10 * 9);
  }
  SECTION("removed particles do not count") {
    for (auto& f : p.flags) f |= kRemoved;
    CHECK_FALSE(measure_pool(p, kSpacing, std::nullopt, 0).exists);
  }
}

TEST_CASE("the seam is measured along the feed and frozen spatter left out") {
  Particles p;
  block(p, Vec3(0, -2e-4, -3e-4), 5, 4, 3, false, kResolidified);
  block(p, Vec3(5e-4, -3e-4, -6e-4), 5, 6, 6, false, kResolidified);
  block(p, Vec3(3e-4, 1e-3, 2e-4), 2, 2, 2, false, kResolidified);
  const auto seam = measure_seam(p, kSpacing);
  REQUIRE(seam.size() == 10);
  CHECK(seam[0].x == Approx(0.5e-4));
  for (int i = 0; i < 10; ++i) {
    CHECK(seam[i].depth == Approx(i < 5 ? 3e-4 : 6e-4));
    CHECK(seam[i].width == Approx(i < 5 ? 4e-4 : 6e-4));
    CHECK(seam[i].top == Approx(0).margin(1e-12));
  }
}

TEST_CASE("clusters are numbered by their first member and link by distance only") {
  Particles p;
  for (const double x : {5.0, -3.0, 5.9, -2.1, 0.0}) p.add(Vec3(x, 0, 0), 0, 1, 1);
  CHECK(clusters(p, {0, 1, 2, 3, 4}, 1.0) == std::vector<std::int32_t>{0, 1, 0, 1, 2});
}
