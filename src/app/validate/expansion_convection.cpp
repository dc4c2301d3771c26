// SPDX-License-Identifier: MIT
#include <cmath>

#include "app/validate/sampling.hpp"
#include "app/validate/scenes.hpp"

namespace meltray::app {
namespace {

constexpr double kMiddle = 400;  ///< mean of the wall temperatures [K]
constexpr int kLooks = 20;       ///< over the last fifth of the run

/// Means of a run.
struct Flow {
  double nusselt = 0;  ///< heat across the tank over conduction alone
  double rms = 0;      ///< of the speed
  double rise = 0;     ///< largest v on z = 1/2
  double seconds = 0;
};

/// Convection of every particle and the conduction between the walls, which are one apart and at one degree.
double nusselt(const Particles& p, double conductivity) {
  double flow = 0;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (!p.is_wall(i)) flow += p.mass[i] * p.v[0][i] * (p.temperature[i] - kMiddle);
  return 1 + flow / conductivity;
}

double largest_rise(const Particles& p, double spacing) {
  return peak(
             [&](double x) {
               return sample(p, {x, 0.5, 0}, 3 * spacing, [&](std::size_t i) { return p.v[1][i]; });
             },
             spacing, 0.5, 41)
      .value;
}

Flow run(const Setting& setting, const scene::Overrides& overrides, double spacing, double end) {
  const Watch watch;
  scene::Overrides all = overrides;
  all.push_back("domain.spacing_m=" + std::to_string(spacing));
  const auto simulation = start(setting, all);
  const double conductivity = simulation->scene().material.conductivity_liquid(kMiddle);
  Flow out;
  for (int k = 1; k <= kLooks; ++k) {
    advance(*simulation, end * (0.8 + 0.2 * k / kLooks));
    const Particles& p = simulation->particles();
    out.nusselt += nusselt(p, conductivity) / kLooks;
    out.rms += rms_speed(p) / kLooks;
    out.rise += largest_rise(p, spacing) / kLooks;
  }
  out.seconds = watch.seconds();
  return out;
}

}  // namespace

Rows expansion_convection(const Setting& setting) {
  const std::vector<double> spacings =
      setting.small ? std::vector<double>{0.05} : std::vector<double>{0.04, 0.025};
  const double end = setting.small ? 1.0 : 2.0;
  const double line = setting.small ? 0.1 : 0.03;
  std::vector<Rows> series(4);
  for (const double spacing : spacings) {
    const Flow boussinesq = run(setting, {}, spacing, end);
    const Flow expansion =
        run(setting, {"flow.thermal_expansion=true", "terms.buoyancy=false"}, spacing, end);
    const Measured how{resolution_text(spacing), expansion.seconds, "WCSPH with Boussinesq's buoyancy"};
    series[0].push_back(
        relative_row("Nusselt number, mean", expansion.nusselt, boussinesq.nusselt, line, how));
    series[1].push_back(relative_row("rms speed", expansion.rms, boussinesq.rms, line, how));
    series[2].push_back(relative_row("largest v on z = 1/2", expansion.rise, boussinesq.rise, line, how));
    if (setting.small) continue;
    const Flow isph = run(setting, {"flow.solver=isph", "flow.shifting=4"}, spacing, end);
    series[3].push_back(relative_row("Nusselt number with Boussinesq's buoyancy, WCSPH / ISPH",
                                     boussinesq.nusselt, isph.nusselt, 0,
                                     {resolution_text(spacing), boussinesq.seconds, "ISPH"}));
  }
  Rows rows;
  for (std::size_t s = 0; s < series.size(); ++s) {
    if (series[s].empty()) continue;
    add_series(rows, spacings, series[s]);
    rows.back().judged = s < 2;  // a peak swings with single particles, solvers differ by their errors
  }
  return rows;
}

}  // namespace meltray::app
