// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "app/schedule.hpp"

using meltray::app::next_multiple;

TEST_CASE("times of output are the numbers a person would write") {
  CHECK(next_multiple(0, 1e-5) == 1e-5);
  CHECK(next_multiple(2e-5, 1e-5) == 3e-5);  // 3 * 1e-5 is 3.0000000000000004e-5
  CHECK(next_multiple(5.9e-5, 2e-5) == 6e-5);
  CHECK(next_multiple(0.123, 0) == 1e300);
}

TEST_CASE("stepping from multiple to multiple meets every one once") {
  for (const double interval : {1e-5, 3e-7, 7e-6, 1e-4}) {
    double t = 0;
    for (int k = 1; k <= 20000; ++k) {
      t = next_multiple(t, interval);
      REQUIRE(t == Approx(k * interval).epsilon(1e-11));
    }
    // The same from a time that was rounded in a file.
    CHECK(next_multiple(t * (1 - 1e-15), interval) == next_multiple(t, interval));
  }
}
