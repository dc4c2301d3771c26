// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "app/validate/scenes.hpp"
#include "meltray/core/constants.hpp"

namespace meltray::app {
namespace {

constexpr double kRadius = 5e-4;
constexpr double kStretch = 1.05;
constexpr double kTemperature = 1900;

/// Longer over shorter spread of the drop about its centre, less one: (M_zz - M_xx) / (M_zz + M_xx).
double deformation(const Particles& p) {
  const auto n = static_cast<double>(p.size());
  double mean[2] = {0, 0}, moment[2] = {0, 0};
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t c = 0; c < 2; ++c) mean[c] += p.x[c][i] / n;
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t c = 0; c < 2; ++c) moment[c] += std::pow(p.x[c][i] - mean[c], 2);
  return (moment[1] - moment[0]) / (moment[1] + moment[0]);
}

struct Oscillation {
  double frequency = 0;  ///< [Hz]
  double damping = 0;    ///< of the amplitude [1/s]
  double exact_frequency = 0, exact_damping = 0;
  double seconds = 0;
};

/// Frequency from the first to the last zero of a record, damping from the extremes between zeros by least
/// squares of their logarithms.
Oscillation analyse(const std::vector<std::pair<double, double>>& record) {
  std::vector<double> zeros, times, logs;
  double extreme = 0, when = 0;
  for (std::size_t k = 1; k < record.size(); ++k) {
    const auto [t0, a0] = record[k - 1];
    const auto [t1, a1] = record[k];
    if (a0 * a1 <= 0 && a0 != a1) {
      if (!zeros.empty()) {
        times.push_back(when);
        logs.push_back(std::log(extreme));
      }
      zeros.push_back(t0 - a0 * (t1 - t0) / (a1 - a0));
      extreme = 0;
    }
    if (std::abs(a1) > extreme) {
      extreme = std::abs(a1);
      when = t1;
    }
  }
  Oscillation out;
  if (zeros.size() < 3) return {std::nan(""), std::nan("")};
  out.frequency = 0.5 * static_cast<double>(zeros.size() - 1) / (zeros.back() - zeros.front());
  const auto n = static_cast<double>(times.size());
  double st = 0, sl = 0, stt = 0, stl = 0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    st += times[k];
    sl += logs[k];
    stt += times[k] * times[k];
    stl += times[k] * logs[k];
  }
  out.damping = -(n * stl - st * sl) / (n * stt - st * st);
  return out;
}

Oscillation run(const Setting& setting, const char* metal, int per_radius, double periods) {
  const Watch watch;
  const auto simulation = start(setting, {fmt::format("material.name={}", metal),
                                          fmt::format("domain.spacing_m={}", kRadius / per_radius)});
  const Material& m = simulation->scene().material;
  const double radius = equivalent_radius(simulation->particles(), m.density);
  // n = 2 in two dimensions: omega^2 = n (n^2 - 1) sigma / (rho R^3), damping 2 n (n - 1) nu / R^2.
  const double exact =
      std::sqrt(6 * m.sigma(kTemperature) / (m.density * std::pow(radius, 3))) / (2 * constants::pi);
  std::vector<std::pair<double, double>> record{{0, deformation(simulation->particles())}};
  advance(*simulation, periods / exact,
          [&] { record.emplace_back(simulation->time(), deformation(simulation->particles())); });
  Oscillation out = analyse(record);
  out.exact_frequency = exact;
  out.exact_damping = 4 * m.viscosity(kTemperature) / m.density / (radius * radius);
  out.seconds = watch.seconds();
  return out;
}

}  // namespace

Rows oscillating_drop(const Setting& setting) {
  struct Variant {
    const char *name, *metal;
    std::vector<int> per_radius;
  };
  std::vector<Variant> variants = {{"Fe 2-D", "iron", {10, 15, 20}}, {"Al 2-D", "aluminium", {10, 15, 20}}};
  if (setting.small) variants = {{"Fe 2-D", "iron", {10}}};
  Rows rows;
  for (const Variant& v : variants) {
    std::vector<double> scales;
    Rows frequencies, dampings;
    for (const int per_radius : v.per_radius) {
      const Oscillation o = run(setting, v.metal, per_radius, setting.small ? 1.5 : 3.5);
      const Measured how{fmt::format("R/dx {}", per_radius), o.seconds, "Rayleigh 1879, cylinder"};
      scales.push_back(1.0 / per_radius);
      frequencies.push_back(
          relative_row(fmt::format("{}: frequency [Hz]", v.name), o.frequency, o.exact_frequency, 0.03, how));
      frequencies.back().goal = 0.02;
      dampings.push_back(relative_row(fmt::format("{}: damping [1/s]", v.name), o.damping, o.exact_damping, 0,
                                      {how.resolution, how.seconds, "Lamb 1932, art. 355, cylinder"}));
    }
    add_series(rows, scales, frequencies);
    add_series(rows, scales, dampings);
    for (std::size_t k = 0; k < scales.size(); ++k) rows[rows.size() - 1 - k].judged = false;
  }
  return rows;
}

}  // namespace meltray::app
