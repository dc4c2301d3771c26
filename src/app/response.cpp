// SPDX-License-Identifier: MIT
#include "app/response.hpp"

#include "meltray/core/errors.hpp"
#include "meltray/observe/harmonics.hpp"

namespace meltray::app {

DepthResponse depth_response(const History& history, const std::string& column, double frequency) {
  if (!history.contains("time_s")) throw UsageError("history.csv has no rows");
  const auto& t = history.at("time_s");
  const auto power = observe::analyse_periods(t, history.at("laser_power_w"), frequency);
  const auto depth = observe::analyse_periods(t, history.at(column), frequency);
  if (!(power.half_range > 0)) throw UsageError("the power of the laser does not change over the periods");
  // The amplitude of the drive is taken in the same way as that of the response. m/W is 1e6 mm/kW.
  DepthResponse r;
  r.periods = depth.periods;
  r.half_range_ratio = 1e6 * depth.half_range / power.half_range;
  r.half_range_spread = 1e6 * depth.half_range_spread / power.half_range;
  r.harmonic_ratio = 1e6 * depth.harmonic / power.harmonic;
  r.mean = 1e3 * depth.mean;
  r.lag = observe::phase_lag_deg(power, depth);
  return r;
}

}  // namespace meltray::app
