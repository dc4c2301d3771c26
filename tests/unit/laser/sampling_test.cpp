// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "meltray/laser/laser.hpp"

using namespace meltray;
using namespace meltray::laser;

namespace {

constexpr double kEdge = 1e-4;

/// Hits of random rays, one each, in `cubes` cubes side by side.
std::vector<Hit> random_hits(int rays, int cubes, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> along(0, cubes * kEdge);
  std::vector<Hit> hits;
  for (int r = 0; r < rays; ++r)
    hits.push_back(
        {Vec3(along(random), 0.3 * kEdge, -0.4 * kEdge), 1.0 / rays, static_cast<std::uint32_t>(r)});
  return hits;
}

double mean_error(int rays, int cubes) {
  double sum = 0;
  constexpr int kSeeds = 50;
  for (unsigned s = 0; s < kSeeds; ++s) sum += sampling_error(random_hits(rays, cubes, s), kEdge);
  return sum / kSeeds;
}

}  // namespace

TEST_CASE("sampling error: none where the halves agree, all where they never meet") {
  std::vector<Hit> hits;
  CHECK(sampling_error(hits, kEdge) == 0);
  for (std::uint32_t r = 0; r < 8; ++r) hits.push_back({Vec3((r / 2 + 0.5) * kEdge, 0, 0), 2.0, r});
  CHECK(sampling_error(hits, kEdge) < 1e-15);
  for (std::uint32_t r = 0; r < 8; ++r) hits[r].position[0] = (r + 0.5) * kEdge;
  CHECK(sampling_error(hits, kEdge) == Approx(1).epsilon(1e-12));
  CHECK(sampling_error(hits, 2 * kEdge) < 1e-15);
}

TEST_CASE("sampling error is the mean error of random samples and falls with the root of their number") {
  // Of n hits in one of m cubes n/m differ by sqrt(n/m) on average times sqrt(2/pi).
  const double expected = std::sqrt(2 / M_PI * 20 / 2000);
  CHECK(mean_error(2000, 20) == Approx(expected).epsilon(0.05));
  CHECK(mean_error(8000, 20) == Approx(expected / 2).epsilon(0.05));
}

TEST_CASE("the number of rays is that which the error target takes") {
  RayCount count(0.1, 5000);
  CHECK(count.next() == 5000);  // nothing known
  count.learn(0.2, 500);
  CHECK(count.next() == 2000);  // twice the target with 500: four times as many
  for (int n = 0; n < 300; ++n) count.learn(0.05, 1000);
  CHECK(std::abs(count.next() - 250) <= 1);
  for (int n = 0; n < 300; ++n) count.learn(0, 250);
  CHECK(count.next() == 100);  // the fewest
  for (int n = 0; n < 300; ++n) count.learn(1, 5000);
  CHECK(count.next() == 5000);
  RayCount few(0.1, 7);
  few.learn(0, 7);
  CHECK(few.next() == 7);
}

TEST_CASE("the tracer numbers the rays of its hits") {
  SurfaceMesh mesh;
  mesh.vertices = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(0, 1, 0)};
  mesh.triangles = {{0, 1, 2}};
  Tracer tracer;
  tracer.set_mesh(mesh);
  std::vector<Ray> rays(5, {Vec3(0, 0, 1), Vec3(0, 0, -1), 1.0});
  rays[3].origin[0] = 5;  // misses
  TraceOptions options;
  options.fixed_absorptance = 0.5;
  const Trace trace = tracer.trace(rays, options);
  REQUIRE(trace.hits.size() == 4);
  CHECK(trace.hits[2].ray == 2);
  CHECK(trace.hits[3].ray == 4);
}
