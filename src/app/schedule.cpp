// SPDX-License-Identifier: MIT
#include "app/schedule.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace meltray::app {

double next_multiple(double t, double interval) {
  if (interval <= 0) return 1e300;
  const double k = std::floor(t / interval * (1 + kSameTime) + kSameTime) + 1;
  return std::strtod(fmt::format("{:.12g}", k * interval).c_str(), nullptr);
}

}  // namespace meltray::app
