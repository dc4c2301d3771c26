// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "app/validate/scenes.hpp"
#include "meltray/core/constants.hpp"
#include "meltray/core/errors.hpp"

namespace meltray::app {
namespace {

constexpr double kLength = 0.2, kThickness = 0.02;
/// k L of the first mode of a beam clamped at one end: cos(kL) cosh(kL) = -1.
constexpr double kFirstMode = 1.875104;
/// Speed of the free end at the start over that of sound, sqrt(K / rho): it swings out by an eighth of L.
constexpr double kStartSpeed = 0.01;

/// Deflection of the mode along the plate, 1 at the free end.
double mode(double x) {
  const double k = kFirstMode / kLength, a = kFirstMode;
  const auto shape = [&](double s) {
    return (std::cos(a) + std::cosh(a)) * (std::cosh(k * s) - std::cos(k * s)) +
           (std::sin(a) - std::sinh(a)) * (std::sinh(k * s) - std::sin(k * s));
  };
  return shape(x) / shape(kLength);
}

/// Thin plate in plane strain: omega^2 = E H^2 k^4 / (12 rho (1 - nu^2)).
double frequency(const Material& m) {
  const double k = kFirstMode / kLength, nu = m.poisson_ratio;
  return k * k * kThickness * std::sqrt(m.youngs_modulus / (12 * m.density * (1 - nu * nu)));
}

struct Swing {
  double period = 0, amplitude = 0, loss = 0;  ///< [s], [m], share of the amplitude lost in a period
  double start_speed = 0, seconds = 0;
};

Swing run(const Setting& setting, double spacing, double periods) {
  const Watch watch;
  const auto simulation = start(setting, {fmt::format("domain.spacing_m={}", spacing)});
  const Material& m = simulation->scene().material;
  Swing swing;
  swing.start_speed = kStartSpeed * std::sqrt(m.youngs_modulus / (3 * (1 - 2 * m.poisson_ratio)) / m.density);
  Particles& p = simulation->particles();
  std::vector<std::size_t> end;  // the outermost column
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_wall(i)) continue;
    p.v[1][i] = swing.start_speed * mode(p.x[0][i]);
    if (p.x[0][i] > kLength - spacing) end.push_back(i);
  }
  std::vector<double> crossings = {0}, peaks;
  double before = 0, t_before = 0, peak = 0;
  advance(*simulation, periods * 2 * constants::pi / frequency(m), [&] {
    double z = 0;
    for (const std::size_t i : end) z += simulation->particles().x[1][i] / static_cast<double>(end.size());
    const double t = simulation->time();
    peak = std::max(peak, std::abs(z));
    if (before * z < 0) {
      crossings.push_back(t_before + (t - t_before) * before / (before - z));
      peaks.push_back(peak);
      peak = 0;
    }
    before = z;
    t_before = t;
  });
  if (peaks.empty()) throw NumericalFailure("elastic_plate: the plate does not swing back");
  swing.period = 2 * crossings.back() / static_cast<double>(peaks.size());
  swing.amplitude = peaks.front();
  if (peaks.size() > 2) swing.loss = 1 - peaks[2] / peaks[0];
  swing.seconds = watch.seconds();
  return swing;
}

}  // namespace

Rows elastic_plate(const Setting& setting) {
  // The small twin ends with the first half of a period, at the resolution that is judged.
  const std::vector<double> spacings = setting.small ? std::vector<double>{kThickness / 10}
                                                     : std::vector<double>{kThickness / 5, kThickness / 10};
  Rows periods, amplitudes, losses;
  for (const double spacing : spacings) {
    const Swing swing = run(setting, spacing, setting.small ? 0.55 : 2.0);
    const double omega = frequency(start(setting)->scene().material);
    const Measured how{fmt::format("H/dx {:.0f}", kThickness / spacing), swing.seconds,
                       "thin plate, first mode"};
    periods.push_back(relative_row("period [s]", swing.period, 2 * constants::pi / omega, 0.05, how));
    amplitudes.push_back(
        relative_row("amplitude [m]", swing.amplitude, swing.start_speed / omega, 0.05, how));
    if (!setting.small) losses.push_back(limit_row("amplitude lost in a period", swing.loss, 0.05, how));
  }
  Rows rows;
  add_series(rows, spacings, periods);
  add_series(rows, spacings, amplitudes);
  add_series(rows, spacings, losses);
  return rows;
}

}  // namespace meltray::app
