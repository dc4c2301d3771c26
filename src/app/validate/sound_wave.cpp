// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "app/validate/scenes.hpp"
#include "meltray/core/constants.hpp"
#include "meltray/sph/kernel.hpp"

namespace meltray::app {
namespace {

constexpr double kNumber = 2 * constants::pi;  ///< of the wave: one wavelength in the box
constexpr double kMach = 1e-4;                 ///< largest speed over that of sound

/// u = U sin(k x) everywhere.
void start_wave(scene::Simulation& simulation) {
  const double largest = kMach * simulation.scene().flow.sound_speed;
  Particles& p = simulation.particles();
  for (std::size_t i = 0; i < p.size(); ++i) p.v[0][i] = largest * std::sin(kNumber * p.x[0][i]);
}

/// Amplitude of the wave over its first one.
double amplitude(const scene::Simulation& simulation) {
  const Particles& p = simulation.particles();
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) sum += p.v[0][i] * std::sin(kNumber * p.x[0][i]);
  return 2 * sum / static_cast<double>(p.size()) / (kMach * simulation.scene().flow.sound_speed);
}

struct Wave {
  double period = 0;    ///< mean, from the first to the last time the amplitude passes zero
  double left = 0;      ///< largest amplitude in the last period over that in the first
  double expected = 0;  ///< of that
  double seconds = 0;
};

/// Rate at which a diffusion D of the density takes its share of the amplitude, D k^2 / 2 with D = delta h c.
/// Antuono's form diffuses nothing that is smooth.
double diffusion_rate(const scene::Scene& scene) {
  if (scene.flow.density_diffusion != scene::DensityDiffusion::molteni_colagrossi) return 0;
  const double diffusivity =
      scene.flow.diffusion_coefficient * smoothing_length(scene) * scene.flow.sound_speed;
  return 0.5 * diffusivity * kNumber * kNumber;
}

/// Share of the artificial viscosity that the term 0.01 h^2 in its denominator leaves:
/// int F r^5 / (r^2 + 0.01 h^2) dr / int F r^3 dr over the support of the kernel, h = 1, in the plane.
double share_left() {
  constexpr int kSteps = 10000;
  double with = 0, without = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double r = 2 * (k + 0.5) / kSteps, weight = sph::WendlandC2<2>::f(r, 1) * r * r * r;
    with += weight * r * r / (r * r + 0.01);
    without += weight;
  }
  return with / without;
}

/// The same of artificial viscosity, nu k^2 / 2. Of all pairs it is nu = 3 alpha c h / 8 along the wave
/// (Monaghan 2005, sect. 4.1, in two dimensions), of which those act that approach: half of the wave at a
/// time.
double viscosity_rate(const scene::Scene& scene) {
  if (!scene.terms.artificial_viscosity) return 0;
  const double nu = 3.0 / 16 * scene.flow.artificial_viscosity * scene.flow.sound_speed *
                    smoothing_length(scene) * share_left();
  return 0.5 * nu * kNumber * kNumber;
}

Wave run(const Setting& setting, const scene::Overrides& overrides, double spacing) {
  const Watch watch;
  scene::Overrides all = overrides;
  all.push_back(fmt::format("domain.spacing_m={}", spacing));
  const auto simulation = start(setting, all);
  start_wave(*simulation);
  const double expected = 2 * constants::pi / (kNumber * simulation->scene().flow.sound_speed);
  const double end = simulation->scene().time.end;
  double first = 0, last = 0, largest_first = 0, largest_last = 0;
  int zeros = 0;
  advance(*simulation, end, [&, before = 1.0, then = 0.0]() mutable {
    const double t = simulation->time(), a = amplitude(*simulation);
    if (t <= expected) largest_first = std::max(largest_first, std::abs(a));
    if (t > end - expected) largest_last = std::max(largest_last, std::abs(a));
    if (a * before < 0) {
      last = then + (t - then) * before / (before - a);
      if (zeros++ == 0) first = last;
    }
    before = a;
    then = t;
  });
  const double between = end - expected;  // first and last period
  return {2 * (last - first) / (zeros - 1), largest_last / largest_first,
          std::exp(-between * (diffusion_rate(simulation->scene()) + viscosity_rate(simulation->scene()))),
          watch.seconds()};
}

}  // namespace

Rows sound_wave(const Setting& setting) {
  const std::vector<Model> models = {
      {"no diffusion", {}},
      {"antuono", {"flow.density_diffusion=antuono"}},
      {"molteni_colagrossi", {"flow.density_diffusion=molteni_colagrossi"}},
      {"artificial viscosity", {"terms.artificial_viscosity=true", "flow.artificial_viscosity=0.35"}}};
  const std::vector<double> spacings =
      setting.small ? std::vector<double>{0.04} : std::vector<double>{0.04, 0.02, 0.01};
  Rows rows;
  for (const Model& m : models) {
    const std::string name = m.name + ": ";
    Rows periods, amplitudes;
    for (const double spacing : spacings) {
      const Wave wave = run(setting, m.overrides, spacing);
      const Measured how{fmt::format("wavelength/dx {:.0f}", 1 / spacing), wave.seconds,
                         "wavelength over sound speed"};
      periods.push_back(relative_row(name + "period", wave.period, 0.1, setting.small ? 0.03 : 0.01, how));
      amplitudes.push_back(relative_row(name + "amplitude in the fifth period over the first", wave.left,
                                        wave.expected, 0.01, how));
    }
    add_series(rows, spacings, periods);
    add_series(rows, spacings, amplitudes);
  }
  return rows;
}

}  // namespace meltray::app
