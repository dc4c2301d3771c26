// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "app/validate/scenes.hpp"
#include "meltray/core/constants.hpp"
#include "meltray/sph/kernel.hpp"

namespace meltray::app {
namespace {

constexpr double kNumber = 2 * constants::pi;  ///< of the wave: one wavelength along z
constexpr double kLeft = 0.8;                  ///< share of the wave that is left at the end of a run
constexpr double kContinuum = 1.0 / 16;  ///< 1 / (4 (D + 2)) in two dimensions (Monaghan 2005, sect. 4.1)
constexpr double kMach = 1e-4;  ///< first amplitude over c: layers slide by less than a spacing until then

/// Projection of u on sin kz.
double amplitude(const Particles& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) sum += p.v[0][i] * std::sin(kNumber * p.x[1][i]);
  return 2 * sum / static_cast<double>(p.size());
}

/// Kinematic viscosity of the lattice over alpha c h. In shear every second pair approaches, so that nu k^2 =
/// -(1/2) alpha c h sum_j V F x^2 / (r^2 + 0.01 h^2) (1 - cos kz). It is exact for particles in their places.
double lattice_viscosity(const scene::Scene& scene) {
  const double dx = scene.domain.spacing, h = smoothing_length(scene);
  const int reach = static_cast<int>(2 * h / dx);
  double sum = 0;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j) {
      const double x = i * dx, z = j * dx, r2 = x * x + z * z;
      sum -= dx * dx * sph::WendlandC2<2>::f(std::sqrt(r2), 1 / h) * x * x / (r2 + 0.01 * h * h) *
             (1 - std::cos(kNumber * z));
    }
  return 0.5 * sum / (kNumber * kNumber);
}

struct Decay {
  double measured = 0;  ///< viscosity over alpha c h
  double lattice = 0;   ///< what is expected of it
  double seconds = 0;
};

/// In a strip of twelve particles across, periodic.
Decay run(const Setting& setting, double ratio, double spacing) {
  const Watch watch;
  const double width = 12 * spacing;
  const auto simulation = start(
      setting, {fmt::format("domain.spacing_m={}", spacing), fmt::format("domain.smoothing_ratio={}", ratio),
                fmt::format("domain.max_m=[{},1.0]", width), fmt::format("bodies.0.max_m=[{},1.0]", width)});
  const scene::Scene& scene = simulation->scene();
  const double lattice = lattice_viscosity(scene);
  const double unit = scene.flow.artificial_viscosity * scene.flow.sound_speed * smoothing_length(scene);
  const double end = -std::log(kLeft) / (lattice * unit * kNumber * kNumber);
  const double first = kMach * scene.flow.sound_speed;
  Particles& p = simulation->particles();
  for (std::size_t i = 0; i < p.size(); ++i) p.v[0][i] = first * std::sin(kNumber * p.x[1][i]);
  advance(*simulation, end);
  const double rate = -std::log(amplitude(simulation->particles()) / first) / end;
  return {rate / (kNumber * kNumber) / unit, lattice, watch.seconds()};
}

}  // namespace

Rows shear_wave(const Setting& setting) {
  const std::vector<double> spacings =
      setting.small ? std::vector<double>{0.05} : std::vector<double>{0.05, 0.025, 0.0125};
  Rows rows;
  for (const double ratio : {1.3, 1.8}) {
    Rows lattice, continuum;
    const std::string name = fmt::format("h/dx {}: viscosity / (alpha c h)", ratio);
    for (const double spacing : spacings) {
      const Decay d = run(setting, ratio, spacing);
      const std::string resolution = fmt::format("wavelength/dx {:.0f}", 1 / spacing);
      lattice.push_back(
          relative_row(name, d.measured, d.lattice, 0.01, {resolution, d.seconds, "sum over the lattice"}));
      continuum.push_back(relative_row(name + ", continuum", d.measured, kContinuum, 0,
                                       {resolution, d.seconds, "Monaghan 2005, 1/16"}));
    }
    add_series(rows, spacings, lattice);
    add_series(rows, spacings, continuum);
    rows.back().judged = false;  // a kernel of few neighbours does not meet its integral
  }
  return rows;
}

}  // namespace meltray::app
