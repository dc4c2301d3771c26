// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

namespace meltray::observe {

/// Response of a signal to a periodic drive over whole periods, the first one left out.
struct PeriodResponse {
  int periods = 0;
  double mean = 0;               ///< of the period average
  double half_range = 0;         ///< (max - min)/2 of the period average
  double half_range_spread = 0;  ///< standard deviation of that over single periods; 0 for one period
  double harmonic = 0;           ///< amplitude of the first harmonic
  double phase_deg = 0;          ///< the harmonic is harmonic * cos(2 pi f t - phase)
};

/// Analyses samples (t ascending, at least four a period) of a signal driven at `frequency` [Hz]. The first
/// harmonic comes from a least-squares fit of mean, cosine and sine to the samples, which is exact for a pure
/// sine whatever the sampling; the period average is linear between samples. Throws UsageError when less than
/// two periods are there or a period has fewer than four samples.
PeriodResponse analyse_periods(std::span<const double> t, std::span<const double> value, double frequency);

/// Lag of the response behind the drive in [0, 360) degrees.
double phase_lag_deg(const PeriodResponse& drive, const PeriodResponse& response);

}  // namespace meltray::observe
