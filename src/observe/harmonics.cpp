// SPDX-License-Identifier: MIT
#include "meltray/observe/harmonics.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "meltray/core/constants.hpp"
#include "meltray/core/errors.hpp"

namespace meltray::observe {
namespace {

constexpr int kPhases = 360;  // points of the period average
constexpr int kFewest = 4;    // samples in a period

double interpolate(std::span<const double> t, std::span<const double> v, double at) {
  const auto above = std::lower_bound(t.begin(), t.end(), at);
  if (above == t.begin()) return v.front();
  if (above == t.end()) return v.back();
  const auto k = static_cast<std::size_t>(above - t.begin());
  const double w = (at - t[k - 1]) / (t[k] - t[k - 1]);
  return (1 - w) * v[k - 1] + w * v[k];
}

double half_range(const std::vector<double>& v) {
  const auto [low, high] = std::minmax_element(v.begin(), v.end());
  return 0.5 * (*high - *low);
}

double mean_of(const std::vector<double>& v) {
  double s = 0;
  for (const double x : v) s += x;
  return s / static_cast<double>(v.size());
}

}  // namespace

PeriodResponse analyse_periods(std::span<const double> t, std::span<const double> value, double frequency) {
  const double period = 1 / frequency;
  const double length = t.empty() ? 0 : t.back() - t.front();
  const int whole = static_cast<int>(std::floor(length * frequency + 1e-6));
  if (whole < 2)
    throw UsageError(fmt::format("{:.3g} periods of {:.4g} Hz; two are needed (the first is left out)",
                                 length * frequency, frequency));
  PeriodResponse r;
  r.periods = whole - 1;
  const double begin = t.front() + period, end = begin + r.periods * period;

  std::vector<double> average(kPhases, 0.0), ranges;
  for (int n = 0; n < r.periods; ++n) {
    std::vector<double> one(kPhases);
    for (int k = 0; k < kPhases; ++k) {
      one[k] = interpolate(t, value, begin + (n + static_cast<double>(k) / kPhases) * period);
      average[k] += one[k] / r.periods;
    }
    ranges.push_back(half_range(one));
  }
  r.mean = mean_of(average);
  r.half_range = half_range(average);
  const double centre = mean_of(ranges);
  double variance = 0;
  for (const double x : ranges) variance += (x - centre) * (x - centre);
  if (r.periods > 1) r.half_range_spread = std::sqrt(variance / (r.periods - 1));

  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  int samples = 0;
  for (std::size_t k = 0; k < t.size(); ++k) {
    if (t[k] < begin - 1e-6 * period || t[k] >= end - 1e-6 * period) continue;
    const double phase = 2 * constants::pi * frequency * t[k];
    const Eigen::Vector3d row(1, std::cos(phase), std::sin(phase));
    normal += row * row.transpose();
    right += value[k] * row;
    ++samples;
  }
  if (samples < kFewest * r.periods)
    throw UsageError(
        fmt::format("{} samples in {} periods; {} a period are needed", samples, r.periods, kFewest));
  const Eigen::Vector3d fit = normal.ldlt().solve(right);
  r.harmonic = std::hypot(fit[1], fit[2]);
  r.phase_deg = std::atan2(fit[2], fit[1]) * 180 / constants::pi;
  return r;
}

double phase_lag_deg(const PeriodResponse& drive, const PeriodResponse& response) {
  const double lag = std::fmod(response.phase_deg - drive.phase_deg, 360.0);
  return lag < 0 ? lag + 360 : lag;
}

}  // namespace meltray::observe
