// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "app/validate/scenes.hpp"
#include "meltray/core/constants.hpp"

namespace meltray::app {
namespace {

constexpr double kBehind = 1e-3;       ///< where the temperature is compared, behind the source [m]
constexpr double kBeside = 3e-4;       ///< and beside its track [m]
constexpr double kIsotherm = 1811;     ///< [K]
constexpr double kLeastBehind = 3e-4;  ///< nearer to the source its width counts [m]

/// T = T_0 + Q / (2 pi lambda r) exp(-v (r + xi) / (2 a)), xi along the feed: straight behind the source xi =
/// -r, and speed and diffusivity drop out; beside its track they count.
struct PointSource {
  double power, conductivity, initial, speed, diffusivity;
  double rise(double behind, double beside) const {
    const double r = std::hypot(behind, beside);
    return power / (2 * constants::pi * conductivity * r) *
           std::exp(-speed * (r - behind) / (2 * diffusivity));
  }
  double isotherm_end(double temperature) const {
    return power / (2 * constants::pi * conductivity * (temperature - initial));
  }
};

struct Wake {
  double temperature = 0;  ///< on the surface at kBehind [K]
  double beside = 0;       ///< the same at kBeside [K]
  double end = 0;          ///< of the isotherm [m]
  double gained = 0;       ///< enthalpy [J]
  double seconds = 0;
};

/// Temperature of the surface along a line y = const, by distance behind the source: from the rows of
/// particles on either side, extrapolated from the two outermost layers with no gradient at the surface,
/// linear in between.
class Track {
 public:
  Track(const Particles& p, double spacing, double source, double y) : spacing_(spacing), source_(source) {
    for (std::size_t i = 0; i < p.size(); ++i) {
      const double depth = -p.x[2][i] / spacing, weight = 1 - std::abs(p.x[1][i] - y) / spacing;
      if (p.is_wall(i) || weight <= 0 || depth < 0 || depth > 2) continue;
      const auto column = static_cast<std::size_t>((p.x[0][i] - origin_) / spacing);
      if (column >= value_.size()) value_.resize(column + 1, 0.0);
      value_[column] += weight * (depth < 1 ? 1.125 : -0.125) * p.temperature[i];
    }
  }
  double operator()(double behind) const {
    const double s = (source_ - behind - origin_) / spacing_ - 0.5;
    const auto k = static_cast<std::size_t>(s);
    return value_[k] + (s - static_cast<double>(k)) * (value_[k + 1] - value_[k]);
  }

 private:
  static constexpr double origin_ = -0.8e-3;  // x_min of the case
  double spacing_, source_;
  std::vector<double> value_;
};

/// Largest distance behind the source at which the track is as hot as the isotherm.
double isotherm_end(const Track& track) {
  double low = kLeastBehind, high = 4e-3;
  while (high - low > 1e-9) {
    const double middle = 0.5 * (low + high);
    (track(middle) > kIsotherm ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Wake run(const Setting& setting, double spacing, double end) {
  const Watch watch;
  const auto simulation = start(setting, {fmt::format("domain.spacing_m={}", spacing),
                                          fmt::format("laser.focal_diameter_m={}", 2 * spacing)});
  advance(*simulation, end);
  const laser::BeamSpec& beam = simulation->scene().laser->beam;
  const double source = beam.start_x + beam.feed * end;
  const Track track(simulation->particles(), spacing, source, 0);
  const Track beside(simulation->particles(), spacing, source, kBeside);
  const auto energy = simulation->energy();
  return {track(kBehind), beside(kBehind), isotherm_end(track), energy.stored - energy.initial,
          watch.seconds()};
}

}  // namespace

Rows rosenthal(const Setting& setting) {
  const scene::Scene scene = scene::read_case(setting.folder / "case.toml");
  const Material& m = scene.material;
  const double conductivity = m.conductivity_solid(300);
  const PointSource exact{scene.laser->beam.power, conductivity, scene.domain.bodies[0].temperature,
                          scene.laser->beam.feed, conductivity / (m.density * m.heat_capacity_solid)};
  const double end = setting.small ? 30e-3 : scene.time.end;
  const std::vector<double> spacings =
      setting.small ? std::vector<double>{2e-4} : std::vector<double>{2e-4, 1e-4, 5e-5};
  Rows temperatures, sides, ends, energies, rows;
  for (const double spacing : spacings) {
    const Wake wake = run(setting, spacing, end);
    const Measured how{resolution_text(spacing), wake.seconds, "Rosenthal 1946"};
    temperatures.push_back(relative_row("rise of the surface 1 mm behind the source [K]",
                                        wake.temperature - exact.initial, exact.rise(kBehind, 0), 0.03, how));
    sides.push_back(relative_row("the same, 0.3 mm beside the track [K]", wake.beside - exact.initial,
                                 exact.rise(kBehind, kBeside), 0.03, how));
    ends.push_back(
        relative_row("end of the 1811 K isotherm [m]", wake.end, exact.isotherm_end(kIsotherm), 0.02, how));
    energies.push_back(relative_row("enthalpy gained = energy of the beam [J]", wake.gained,
                                    exact.power * end, 1e-9,
                                    {how.resolution, how.seconds, "energy balance"}));
  }
  add_series(rows, spacings, temperatures);
  add_series(rows, spacings, sides);
  add_series(rows, spacings, ends);
  // The twin is too coarse for the pass lines of the wake.
  if (setting.small)
    for (Row& row : rows) row.judged = false;
  rows.insert(rows.end(), energies.begin(), energies.end());
  return rows;
}

}  // namespace meltray::app
