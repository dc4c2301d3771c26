// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

#include "meltray/observe/history.hpp"

namespace meltray::observe {

/// Tells on standard output how far a run is: on a terminal one line that is rewritten, otherwise a line per
/// row of history.csv, flushed at once.
class Progress {
 public:
  Progress(bool quiet, double start, double end);
  /// After a step; on a terminal the line is refreshed a few times a second.
  void step(const scene::StepInfo& step, std::int64_t steps, std::size_t liquid);
  /// After a row of history.csv.
  void row(const HistoryRow& row);
  /// Ends the rewritten line, so that other output starts on a fresh one.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void show(bool rewrite);
  std::string line() const;

  bool quiet_, terminal_;
  double start_, end_;
  Clock::time_point began_, shown_;
  bool open_ = false;
  scene::StepInfo step_;
  std::int64_t steps_ = 0;
  std::size_t liquid_ = 0;
  HistoryRow row_;
};

/// 75 s -> "1:15", 3700 s -> "1:01:40".
std::string clock_text(double seconds);

}  // namespace meltray::observe
