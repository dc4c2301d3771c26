// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "meltray/materials/material.hpp"

using namespace meltray;

namespace {

/// Central difference; its own error is about step^2 f''' / 6.
double difference(const Property& p, double t, double step) {
  return (p(t + step) - p(t - step)) / (2 * step);
}

}  // namespace

TEST_CASE("a constant property has its value everywhere and no slope") {
  const Property p = constant(3.5);
  CHECK(p(0) == 3.5);
  CHECK(p(5000) == 3.5);
  CHECK(p.slope(1000) == 0);
}

TEST_CASE("a linear property follows its line and is held outside its range") {
  const Property p = linear(10, -0.5, 100, 50, 200);
  CHECK(p(100) == 10);
  CHECK(p(120) == Approx(0).margin(1e-14));
  CHECK(p(20) == p(50));
  CHECK(p(300) == p(200));
  CHECK(p.slope(100) == -0.5);
  CHECK(p.slope(49) == 0);
  CHECK(p.slope(201) == 0);
}

TEST_CASE("an Andrade property is 10^(a + b/T) with the matching slope, held outside its range") {
  const Property p = andrade(-3.7209, 2694.95, 1811, 2500);
  CHECK(p(2000) == Approx(std::pow(10.0, -3.7209 + 2694.95 / 2000)).epsilon(1e-14));
  // f'''/f' is of order 1e-5 here, so the difference over 0.1 K is good to about 1e-8.
  CHECK(p.slope(2000) == Approx(difference(p, 2000, 0.1)).epsilon(1e-7));
  CHECK(p(1000) == p(1811));
  CHECK(p(4000) == p(2500));
  CHECK(p.slope(1000) == 0);
  CHECK(p.slope(4000) == 0);
}
