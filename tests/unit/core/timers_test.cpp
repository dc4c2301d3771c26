// SPDX-License-Identifier: MIT
#include "meltray/core/timers.hpp"

#include <catch2/catch.hpp>
#include <chrono>

using namespace meltray;

namespace {

/// Keeps the clock of Timers busy for a time; returns what really passed [s].
double spend(double seconds) {
  const auto start = Timers::Clock::now();
  double passed = 0;
  while (passed < seconds) passed = std::chrono::duration<double>(Timers::Clock::now() - start).count();
  return passed;
}

double total(const Timers& timers) {
  double sum = 0;
  for (int part = 0; part < static_cast<int>(Part::count); ++part)
    sum += timers.seconds(static_cast<Part>(part));
  return sum;
}

}  // namespace

TEST_CASE("time in a nested section counts for the inner part only") {
  Timers timers;
  const auto start = Timers::Clock::now();
  double outer_least = 0, inner_least = 0;
  {
    const auto outer = timers.measure(Part::pressure);
    outer_least += spend(0.004);
    {
      const auto inner = timers.measure(Part::neighbours);
      inner_least += spend(0.010);
    }
    outer_least += spend(0.003);
  }
  const double wall = std::chrono::duration<double>(Timers::Clock::now() - start).count();
  CHECK(timers.seconds(Part::pressure) >= outer_least);
  CHECK(timers.seconds(Part::neighbours) >= inner_least);
  // Exclusive: the parts add up to no more than the wall time, so the inner part is not counted twice.
  CHECK(total(timers) <= wall);
  CHECK(timers.seconds(Part::pressure) <= wall - inner_least);
  CHECK(timers.seconds(Part::neighbours) <= wall - outer_least);
}

TEST_CASE("sections of the same part add up, also when nested") {
  Timers timers;
  const auto start = Timers::Clock::now();
  double least = 0;
  for (int i = 0; i < 3; ++i) {
    const auto section = timers.measure(Part::heat);
    least += spend(0.001);
    const auto again = timers.measure(Part::heat);
    least += spend(0.001);
  }
  const double wall = std::chrono::duration<double>(Timers::Clock::now() - start).count();
  CHECK(timers.seconds(Part::heat) >= least);
  CHECK(timers.seconds(Part::heat) <= wall);
  CHECK(total(timers) == timers.seconds(Part::heat));
}

TEST_CASE("time outside of every section counts for nothing") {
  Timers timers;
  spend(0.002);
  CHECK(total(timers) == 0);
  { const auto section = timers.measure(Part::laser); }
  const double before = total(timers);
  spend(0.002);
  CHECK(total(timers) == before);
}
