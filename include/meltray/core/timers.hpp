// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <chrono>
#include <string_view>

namespace meltray {

/// Parts of a run whose share of the wall time is reported.
enum class Part {
  neighbours,
  surface,
  forces,
  viscosity,
  pressure,
  heat,
  laser,
  phase,
  observe,
  integrator,
  count
};

inline constexpr std::array<std::string_view, static_cast<int>(Part::count)> kPartNames = {
    "neighbours", "surface", "forces", "viscosity", "pressure",
    "heat",       "laser",   "phase",  "observe",   "integrator"};

/// Exclusive wall time by part: time inside a nested section counts for the inner part only.
class Timers {
 public:
  using Clock = std::chrono::steady_clock;

  class Section {
   public:
    Section(Timers& timers, Part part) : timers_(timers), outer_(timers.current_) { timers_.enter(part); }
    ~Section() { timers_.enter(outer_); }
    Section(const Section&) = delete;
    Section& operator=(const Section&) = delete;

   private:
    Timers& timers_;
    Part outer_;
  };

  [[nodiscard]] Section measure(Part part) { return Section(*this, part); }
  /// Seconds spent in `part` since construction.
  double seconds(Part part) const { return seconds_[static_cast<int>(part)]; }

 private:
  void enter(Part part) {
    const auto now = Clock::now();
    if (current_ != Part::count)
      seconds_[static_cast<int>(current_)] += std::chrono::duration<double>(now - since_).count();
    since_ = now;
    current_ = part;
  }

  std::array<double, static_cast<int>(Part::count)> seconds_{};
  Clock::time_point since_{};
  Part current_ = Part::count;
};

}  // namespace meltray
