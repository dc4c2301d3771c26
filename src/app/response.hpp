// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

namespace meltray::app {

/// Answer of a depth to a sinusoidal power, over whole periods, the first one left out.
struct DepthResponse {
  int periods = 0;
  double half_range_ratio = 0;   ///< half of (max - min) of the period average over that of the power [mm/kW]
  double half_range_spread = 0;  ///< standard deviation of it over single periods [mm/kW]
  double harmonic_ratio = 0;     ///< of the amplitudes of the first harmonics [mm/kW]
  double mean = 0;               ///< [mm]
  double lag = 0;                ///< of the first harmonic [deg]
};

/// Columns of a history.csv by name.
using History = std::map<std::string, std::vector<double>>;

/// Analyses `column` [m] of a run whose power oscillates with `frequency` [Hz]. Throws UsageError for less
/// than two periods.
DepthResponse depth_response(const History& history, const std::string& column, double frequency);

}  // namespace meltray::app
