// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "meltray/core/constants.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/observe/harmonics.hpp"

using namespace meltray;
using namespace meltray::observe;

namespace {

struct Signal {
  std::vector<double> t, power, depth;
};

/// Power 2.25 + 1.75 sin(wt) kW; depth 2 + 0.8 sin(wt - lag) + second harmonic, after a start that is wrong.
Signal signal(double f, double lag_deg, double second, double periods, double interval) {
  Signal s;
  for (int k = 0; k * interval <= periods / f * (1 + 1e-12); ++k) {
    const double t = k * interval, w = 2 * constants::pi * f;
    s.t.push_back(t);
    s.power.push_back(2250 + 1750 * std::sin(w * t));
    const bool start = t < 0.99 / f;
    s.depth.push_back(start ? 17.0
                            : 2 + 0.8 * std::sin(w * t - lag_deg * constants::pi / 180) +
                                  second * std::cos(2 * w * t));
  }
  return s;
}

}  // namespace

TEST_CASE("mean, amplitude and lag of a pure sine are exact") {
  const double f = GENERATE(100.0, 250.0, 500.0);
  const double lag = GENERATE(0.0, 37.0, 120.0, 300.0);
  const Signal s = signal(f, lag, 0, 4, 0.02 / f);
  const auto power = analyse_periods(s.t, s.power, f);
  const auto depth = analyse_periods(s.t, s.depth, f);
  CHECK(depth.periods == 3);
  CHECK(depth.mean == Approx(2).epsilon(1e-9));
  CHECK(depth.harmonic == Approx(0.8).epsilon(1e-9));
  CHECK(power.harmonic == Approx(1750).epsilon(1e-9));
  // Linear between 50 samples a period: the extremes are missed by at most 1 - cos(pi/50) = 0.2 %.
  CHECK(depth.half_range == Approx(0.8).epsilon(0.002));
  CHECK(std::remainder(phase_lag_deg(power, depth) - lag, 360.0) == Approx(0).margin(1e-6));
}

TEST_CASE("a second harmonic changes the range and not the first harmonic") {
  const Signal s = signal(100, 90, 0.3, 5, 1e-4);
  const auto depth = analyse_periods(s.t, s.depth, 100);
  CHECK(depth.harmonic == Approx(0.8).epsilon(1e-9));
  // 2 - 0.8 cos(x) + 0.3 cos(2x): largest 2 + 0.8 + 0.3; least where sin(x)(0.8 - 1.2 cos x) = 0, cos x =
  // 2/3.
  const double c = 2.0 / 3, least = -0.8 * c + 0.3 * (2 * c * c - 1);
  CHECK(depth.half_range == Approx(0.5 * (1.1 - least)).epsilon(0.002));
  CHECK(depth.half_range_spread == Approx(0).margin(1e-9));
}

TEST_CASE("an incomplete last period is left out") {
  const Signal s = signal(100, 50, 0, 3.7, 2e-4);
  const auto depth = analyse_periods(s.t, s.depth, 100);
  CHECK(depth.periods == 2);
  CHECK(depth.mean == Approx(2).epsilon(1e-9));
}

TEST_CASE("too short or too coarse a signal is refused") {
  const Signal s = signal(100, 0, 0, 1.9, 2e-4);
  CHECK_THROWS_WITH(analyse_periods(s.t, s.depth, 100), Catch::Contains("two are needed"));
  const Signal coarse = signal(100, 0, 0, 5, 4e-3);
  CHECK_THROWS_AS(analyse_periods(coarse.t, coarse.depth, 100), UsageError);
}
