// SPDX-License-Identifier: MIT
#pragma once

namespace meltray::app {

/// Two times closer than this (relative) are one: multiples of different intervals differ by rounding only.
inline constexpr double kSameTime = 1e-9;

/// Next multiple of `interval` after t (1e300 for interval 0), rounded to 12 digits so that it is the number
/// a person would write. Depends on nothing but its arguments: a resumed run stops at the same times.
double next_multiple(double t, double interval);

}  // namespace meltray::app
