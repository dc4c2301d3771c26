// SPDX-License-Identifier: MIT
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "meltray/core/constants.hpp"
#include "meltray/laser/laser.hpp"

using namespace meltray;
using namespace meltray::laser;

namespace {
double at(std::complex<double> m, double degrees) {
  return absorptance(m, std::cos(degrees * constants::pi / 180));
}
}  // namespace

TEST_CASE("fresnel absorptance agrees with tabulated values") {
  struct Row {
    std::complex<double> index;
    std::array<double, 9> a;
    double peak, peak_degrees;
  };
  const std::array<double, 9> angles = {0, 45, 60, 70, 75, 80, 84, 86, 88};
  const std::array<Row, 8> rows = {{
      {{2.927, 4.377}, {0.339, 0.347, 0.367, 0.391, 0.402, 0.396, 0.345, 0.282, 0.175}, 0.404, 76.7},
      {{2.97, 4.06}, {0.368, 0.376, 0.395, 0.417, 0.425, 0.413, 0.355, 0.289, 0.178}, 0.425, 75.6},
      {{3.22, 4.29}, {0.356, 0.364, 0.384, 0.409, 0.421, 0.416, 0.365, 0.301, 0.188}, 0.423, 76.9},
      {{3.6, 5.0}, {0.312, 0.321, 0.343, 0.375, 0.394, 0.403, 0.370, 0.313, 0.202}, 0.404, 79.2},
      {{1.400, 9.891}, {0.054, 0.057, 0.065, 0.080, 0.094, 0.114, 0.127, 0.119, 0.082}, 0.127, 84.1},
      {{1.255, 10.36}, {0.045, 0.047, 0.054, 0.067, 0.079, 0.097, 0.110, 0.105, 0.073}, 0.110, 84.3},
      {{1.026, 9.319}, {0.045, 0.048, 0.055, 0.067, 0.078, 0.094, 0.102, 0.093, 0.062}, 0.102, 83.7},
      {{3.01, 10.98}, {0.088, 0.093, 0.106, 0.130, 0.152, 0.185, 0.213, 0.209, 0.156}, 0.215, 84.8},
  }};
  for (const Row& row : rows) {
    CAPTURE(row.index);
    for (std::size_t i = 0; i < angles.size(); ++i) {
      CAPTURE(angles[i]);
      CHECK(at(row.index, angles[i]) == Approx(row.a[i]).margin(1e-3));  // three digits are tabulated
    }
    double best = 0, best_angle = 0;
    for (double angle = 60; angle < 90; angle += 0.05)
      if (at(row.index, angle) > best) best = at(row.index, angle), best_angle = angle;
    CHECK(best == Approx(row.peak).margin(1e-3));
    CHECK(best_angle == Approx(row.peak_degrees).margin(0.15));
  }
}

TEST_CASE("fresnel at normal and grazing incidence") {
  const std::complex<double> m{2.927, 4.377};
  const double n = m.real(), k = m.imag();
  const double normal = 4 * n / ((n + 1) * (n + 1) + k * k);  // 1 - |(m - 1)/(m + 1)|^2
  CHECK(absorptance(m, 1.0) == Approx(normal).epsilon(1e-14));
  CHECK(fresnel(m, 1.0).s == Approx(fresnel(m, 1.0).p).epsilon(1e-14));
  CHECK(absorptance(m, 0.0) == Approx(0).margin(1e-14));
  // Cosines a little outside [0, 1] come from rounding.
  CHECK(absorptance(m, 1.0 + 1e-9) == absorptance(m, 1.0));
  CHECK(absorptance(m, -1e-9) == absorptance(m, 0.0));
}

TEST_CASE("fresnel p reflectance vanishes at Brewster's angle of glass") {
  const double angle = std::atan(1.5);
  CHECK(fresnel({1.5, 0}, std::cos(angle)).p == Approx(0).margin(1e-28));
  CHECK(fresnel({1.5, 0}, std::cos(angle)).s > 0.1);
}
