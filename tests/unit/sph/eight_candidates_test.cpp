// SPDX-License-Identifier: MIT
#include "sph/eight_candidates.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "unit/terms/stage_setup.hpp"

using namespace meltray;
using namespace meltray::sph;

TEST_CASE("eight candidates: those within reach, by the distance to the nearest image") {
  test::Noise noise(11);
  const auto near = [&](double x) { return static_cast<float>(2 * x); };
  int within = 0, beyond = 0;
  for (int n = 0; n < 500; ++n) {
    SearchedRow<3> row{};
    std::array<std::array<float, 8>, 3> x{};
    std::array<float, 8> h{};
    for (int c = 0; c < 3; ++c) {
      row.x[c] = near(noise());
      for (float& value : x[c]) value = near(noise());
    }
    for (float& value : h) value = 0.8F + 0.1F * near(noise());
    h[7] = std::numeric_limits<float>::quiet_NaN();  // as what fills up the last eight
    row.reach = 0.9F;
    row.rounding = 1;
    const bool wraps = n % 2 == 1;
    row.period[0] = 3;
    row.inverse_period[0] = 1.0F / 3;
    const std::array<const float*, 3> places{x[0].data(), x[1].data(), x[2].data()};
    const unsigned mask =
        wraps ? within_reach<3, true>(row, places, h.data()) : within_reach<3, false>(row, places, h.data());
    CHECK(mask >> 7 == 0);
    for (unsigned l = 0; l < 7; ++l) {
      double r2 = 0;
      for (int c = 0; c < 3; ++c) {
        double d = static_cast<double>(row.x[c]) - x[c][l];
        if (wraps && c == 0) d -= 3 * std::rint(d / 3);
        r2 += d * d;
      }
      const double gap = std::sqrt(r2) - row.reach - h[l];
      if (std::abs(gap) < 1e-4) continue;  // single precision
      CHECK((mask >> l & 1) == (gap < 0 ? 1U : 0U));
      ++(gap < 0 ? within : beyond);
    }
  }
  CHECK((within > 100 && beyond > 100));
}

TEST_CASE("eight candidates: marked ones come out in order and without the row itself") {
  std::array<Index, 8> index{};
  for (Index l = 0; l < 8; ++l) index[l] = 10 * l;
  for (unsigned mask = 0; mask < 256; ++mask) {
    std::vector<Index> expected;
    for (unsigned l = 0; l < 8; ++l)
      if ((mask >> l & 1) != 0 && index[l] != 30) expected.push_back(index[l]);
    std::array<Index, 8> out{};
    const Index count = take_marked(index.data(), mask, 30, out.data());
    CHECK(std::vector<Index>(out.begin(), out.begin() + count) == expected);
  }
}
