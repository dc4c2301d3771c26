// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>

#include "laser/grid_filter.hpp"
#include "laser/smooth_normals.hpp"
#include "meltray/core/constants.hpp"

using namespace meltray;
using namespace meltray::laser;

TEST_CASE("binomial weights are Pascal's row with variance n/2") {
  CHECK(binomial(0) == std::vector<float>{1});
  CHECK(binomial(2) == std::vector<float>{6.0F / 16, 4.0F / 16, 1.0F / 16});
  const std::vector<float> taps = binomial(5);
  double sum = static_cast<double>(taps[0]), variance = 0;
  for (std::size_t d = 1; d < taps.size(); ++d) {
    sum += 2 * static_cast<double>(taps[d]);
    variance += 2.0 * static_cast<double>(taps[d]) * static_cast<double>(d * d);
  }
  CHECK(sum == Approx(1).epsilon(1e-6));
  CHECK(variance == Approx(2.5).epsilon(1e-6));
}

TEST_CASE("a filter spreads one node as the product of its weights, and a constant stays") {
  const Nodes n{7, 6, 5};
  const std::vector<float> taps{0.5F, 0.2F, 0.05F};
  std::vector<float> values(210, 0.0F), ones(210, 1.0F);
  const auto at = [&](std::ptrdiff_t i, std::ptrdiff_t j, std::ptrdiff_t k) {
    return static_cast<std::size_t>((k * n[1] + j) * n[0] + i);
  };
  values[at(3, 3, 2)] = 1;
  filter(values, n, taps);
  filter(ones, n, taps);
  CHECK(values[at(3, 3, 2)] == Approx(0.125));
  CHECK(values[at(1, 3, 2)] == Approx(0.05 * 0.5 * 0.5));
  CHECK(values[at(4, 2, 4)] == Approx(0.2 * 0.2 * 0.05));
  CHECK(values[at(6, 3, 2)] == 0);
  for (const float v : ones) CHECK(v == Approx(1).epsilon(1e-6));
}

namespace {

/// Two square walls of a groove along y that meet at its tip, with normals tilted at random by up to
/// `tilt` in every component.
SurfaceMesh groove(double half_angle, double tilt) {
  SurfaceMesh mesh;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> shift(-tilt, tilt);
  const int n = 20;
  // Columns from the rim of the left wall through the tip to the rim of the right one.
  for (int i = -n; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double side = i < 0 ? -1 : 1;
      mesh.vertices.emplace_back(i * std::sin(half_angle), j, std::abs(i) * std::cos(half_angle));
      Vec3 normal(-side * std::cos(half_angle), 0, std::sin(half_angle));
      normal += Vec3(shift(random), shift(random), shift(random));
      mesh.normals.push_back(normal.normalized());
    }
  for (int i = 0; i < 2 * n; ++i)
    for (int j = 0; j < n; ++j) {
      const std::int32_t a = i * (n + 1) + j, b = a + n + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  mesh.liquid.assign(mesh.vertices.size(), 0);
  return mesh;
}

double mean_error(const SurfaceMesh& mesh, double half_angle) {
  double sum = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const double side = mesh.vertices[v].x() < 0 ? -1 : 1;
    const Vec3 normal(-side * std::cos(half_angle), 0, std::sin(half_angle));
    sum += std::acos(std::min(1.0, mesh.normals[v].dot(normal)));
  }
  return sum / static_cast<double>(mesh.vertices.size());
}

}  // namespace

TEST_CASE("averaging calms normals and keeps the walls of a groove apart") {
  const double half_angle = 15 * constants::pi / 180;
  SurfaceMesh sharp = groove(half_angle, 0);
  smooth_normals(sharp, 4);
  CHECK(mean_error(sharp, half_angle) < 1e-7);  // acos near 1; the walls are 150 degrees apart
  SurfaceMesh rough = groove(half_angle, 0.15);
  const double before = mean_error(rough, half_angle);
  smooth_normals(rough, 4);
  CHECK(mean_error(rough, half_angle) < 0.35 * before);
  for (const Vec3& n : rough.normals) CHECK(n.norm() == Approx(1).epsilon(1e-12));
}
