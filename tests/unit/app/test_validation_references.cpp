// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "app/validate/diffuse_cavity.hpp"
#include "app/validate/neumann.hpp"
#include "app/validate/sampling.hpp"

using namespace meltray;
using namespace meltray::app;

// Constants of the similarity solutions, solved independently to six digits.
TEST_CASE("Neumann's constant for iron and aluminium, and in one phase") {
  CHECK(Neumann{7035, 247e3, 36, 824, 34, 690, 2811, 1811, 1300}.lambda() == Approx(0.614740).margin(1e-6));
  CHECK(Neumann{7035, 247e3, 36, 824, 34, 690, 2811, 1811, 1811}.lambda() == Approx(0.943899).margin(1e-6));
  CHECK(Neumann{2377, 397e3, 94, 1177, 211, 1170, 1933.47, 933.47, 933.47}.lambda() ==
        Approx(0.910404).margin(1e-6));
  const auto one_phase = [](double stefan) { return Neumann{1, 1, 1, 1, 1, 1, stefan, 0, 0}.lambda(); };
  CHECK(one_phase(0.041) == Approx(0.142215).margin(1e-6));
  CHECK(one_phase(0.5) == Approx(0.464786).margin(1e-6));
  CHECK(one_phase(2.85) == Approx(0.899246).margin(1e-6));
}

TEST_CASE("radiosity of a sphere is exact, Gouffe's formula gives the tabulated values") {
  // A quarter of the sphere is open, so a quarter of what leaves any point of the wall escapes.
  for (const double wall : {0.06, 0.34, 0.9})
    CHECK(radiosity_absorptance(sphere(1, 0.75), wall) ==
          Approx(wall / (1 - 0.75 * (1 - wall))).margin(2e-3));
  CHECK(gouffe_absorptance(cylinder(1, 1), 0.34) == Approx(0.7140).margin(5e-5));
  CHECK(gouffe_absorptance(cylinder(10, 1), 0.06) == Approx(0.7429).margin(5e-5));
  CHECK(gouffe_absorptance(cone(3, 1), 0.34) == Approx(0.8436).margin(5e-5));
  CHECK(gouffe_absorptance(cone(10, 1), 0.06) == Approx(0.5973).margin(5e-5));
}

TEST_CASE("sampling is exact for linear fields, a peak for parabolas") {
  Particles p;
  p.dim = 2;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j) p.add(Vec3(i + 0.3 * (j % 2), j, 0), 0, 1, 1.3);
  const auto field = [&](std::size_t i) { return 2 + 3 * p.x[0][i] - p.x[1][i]; };
  CHECK(sample(p, Vec3(4.2, 5.7, 0), 3, field) == Approx(2 + 3 * 4.2 - 5.7));
  CHECK(sample(p, Vec3(4.2, 9.5, 0), 3, field) == Approx(2 + 3 * 4.2 - 9.5));  // outside the outermost row
  const Peak top = peak([](double x) { return 1 - (x - 0.37) * (x - 0.37); }, 0, 1, 11);
  CHECK(top.at == Approx(0.37));
  CHECK(top.value == Approx(1.0));
}

TEST_CASE("the line of least squares has the slope of a line, and that of scattered points") {
  CHECK(slope_of_line({{1, 5}, {2, 7}, {5, 13}}) == Approx(2));
  CHECK(slope_of_line({{-1, 0}, {0, 3}, {1, 0}, {2, 3}}) == Approx(0.6));
}
