// SPDX-License-Identifier: MIT
#include "meltray/observe/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace meltray::observe {

std::string clock_text(double seconds) {
  const auto s = static_cast<long long>(std::llround(std::max(0.0, seconds)));
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                  : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

Progress::Progress(bool quiet, double start, double end)
    : quiet_(quiet),
      terminal_(::isatty(STDOUT_FILENO) == 1),
      start_(start),
      end_(end),
      began_(Clock::now()),
      shown_(began_) {}

void Progress::step(const scene::StepInfo& step, std::int64_t steps, std::size_t liquid) {
  step_ = step;
  steps_ = steps;
  liquid_ = liquid;
  if (quiet_ || !terminal_) return;
  const auto now = Clock::now();
  if (now - shown_ < std::chrono::milliseconds(250)) return;
  shown_ = now;
  show(true);
}

void Progress::row(const HistoryRow& row) {
  row_ = row;
  liquid_ = row.liquid;
  steps_ = row.steps;
  if (step_.limiter.empty() || step_.t < row.time) step_ = {row.time, row.dt, row.limiter};
  if (!quiet_ && !terminal_) show(false);
}

void Progress::finish() {
  if (open_) std::fputc('\n', stdout);
  open_ = false;
  std::fflush(stdout);
}

void Progress::show(bool rewrite) {
  const std::string text = line();
  if (rewrite) {
    fmt::print("\r{}\x1b[K", text);
    open_ = true;
  } else {
    fmt::print("{}\n", text);
  }
  std::fflush(stdout);
}

std::string Progress::line() const {
  const double wall = std::chrono::duration<double>(Clock::now() - began_).count();
  const double done = step_.t - start_;
  const std::string eta = done > 0 && step_.t < end_ ? clock_text(wall * (end_ - step_.t) / done) : "-";
  const std::string share =
      row_.laser_power > 0 ? fmt::format("{:.0f} %", 100 * row_.absorbed / row_.laser_power) : "-";
  return fmt::format(
      "step {} | t {:.4g}/{:.4g} ms | dt {:.2g} us {} | liquid {} | depth {:.3f} mm{} | absorbed {} | "
      "energy {:.1e} | wall {} | ETA {}",
      steps_, 1e3 * step_.t, 1e3 * end_, 1e6 * step_.dt, step_.limiter, liquid_, 1e3 * row_.capillary_depth,
      row_.closed ? " closed" : "", share, row_.energy_error, clock_text(wall), eta);
}

}  // namespace meltray::observe
