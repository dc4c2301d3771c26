// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "app/validate/scenes.hpp"
#include "meltray/core/constants.hpp"

namespace meltray::app {
namespace {

using constants::pi;

/// Flow that starts between plates at x = 0 and 1: speed over its scale at x and time nu t / H^2.
using Profile = std::function<double(double x, double time)>;

constexpr int kTerms = 200;

/// Body force (Morris et al. 1997, eq. 21), over g H^2 / (8 nu).
double poiseuille(double x, double time) {
  double u = 4 * x * (1 - x);
  for (int n = 1; n < kTerms; n += 2)
    u -= 32 / std::pow(n * pi, 3) * std::sin(n * pi * x) * std::exp(-n * n * pi * pi * time);
  return u;
}

/// Moving plate x = 1 (Morris et al. 1997, eq. 20), over its speed.
double couette(double x, double time) {
  double u = x;
  for (int n = 1; n < kTerms; ++n)
    u += (n % 2 ? -2 : 2) / (n * pi) * std::sin(n * pi * x) * std::exp(-n * n * pi * pi * time);
  return u;
}

struct Instant {
  double centre = 0, exact = 0;  ///< at the particles nearest to the middle
  double profile = 0;            ///< L2 of the error, farther than 3 h from the plates
  double whole = 0;              ///< the same over all particles
};

Instant compare(const Particles& p, const Profile& exact, double time, double scale) {
  Instant out;
  double inner = 0, all = 0, middle = 0, nearest = 1;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (p.is_liquid(i)) nearest = std::min(nearest, std::abs(p.x[0][i] - 0.5));
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.is_liquid(i)) continue;
    const double x = p.x[0][i], u = p.v[1][i] / scale, reference = exact(x, time);
    const double square = std::pow(u - reference, 2);
    out.whole += square;
    ++all;
    if (std::abs(x - 0.5) < nearest + 1e-6) {
      out.centre += u;
      out.exact += reference;
      ++middle;
    }
    if (std::min(x, 1 - x) < 3 * p.smoothing[i]) continue;
    out.profile += square;
    ++inner;
  }
  out.centre /= middle;
  out.exact /= middle;
  out.profile = std::sqrt(out.profile / inner);
  out.whole = std::sqrt(out.whole / all);
  return out;
}

struct Flow {
  Profile exact;
  double scale;           ///< of the speed, with its sign [m/s]
  double earliest_error;  ///< pass line at nu t / H^2 = 0.01, absolute
};

std::vector<Instant> follow(scene::Simulation& simulation, const Flow& flow,
                            const std::vector<double>& times) {
  const Material& m = simulation.scene().material;
  const double viscosity = m.viscosity(400) / m.density;
  std::vector<Instant> instants;
  for (const double time : times) {
    advance(simulation, time / viscosity);
    instants.push_back(compare(simulation.particles(), flow.exact, time, flow.scale));
  }
  return instants;
}

std::vector<int> particles_across(const Setting& setting) {
  return setting.small ? std::vector<int>{20} : std::vector<int>{20, 40, 60};
}

Rows run(const Setting& setting, const Flow& flow) {
  const std::vector<int> counts = particles_across(setting);
  std::vector<double> times = {0.01, 0.02, 0.05, 0.1, 0.2, 0.5};
  if (setting.small) times.resize(4);
  std::vector<std::vector<Instant>> runs;
  std::vector<double> seconds, scales;
  for (const int count : counts) {
    const Watch watch;
    const double spacing = 1.0 / count;
    const auto simulation = start(setting, strip(1, spacing));
    runs.push_back(follow(*simulation, flow, times));
    seconds.push_back(watch.seconds());
    scales.push_back(spacing);
  }
  Rows rows;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::string name = fmt::format("nu t/H^2 {}: ", times[k]);
    Rows centres, profiles, wholes;
    for (std::size_t r = 0; r < counts.size(); ++r) {
      const Measured how{fmt::format("H/dx {}", counts[r]), seconds[r], "series solution"};
      const Instant& now = runs[r][k];
      const double line = k == 0 ? flow.earliest_error : 0.01;
      centres.push_back(absolute_row(name + "middle, over the maximum", now.centre, now.exact, line, how));
      profiles.push_back(limit_row(name + "profile inside, L2 over the maximum", now.profile, 0.01, how));
      wholes.push_back(limit_row(name + "whole profile, L2 over the maximum", now.whole, 0.01, how));
    }
    add_series(rows, scales, centres);
    add_series(rows, scales, profiles);
    add_series(rows, scales, wholes);
  }
  return rows;
}

/// The same liquid between slabs of its own solid, four particles thick.
Rows between_own_solid(const Setting& setting, const Flow& flow) {
  const double time = setting.small ? 0.1 : 0.5;
  Rows rows;
  std::vector<double> scales;
  for (const int count : particles_across(setting)) {
    const Watch watch;
    const double spacing = 1.0 / count, height = strip_height(spacing), slab = 4 * spacing;
    scene::Overrides overrides{fmt::format("domain.spacing_m={:.17g}", spacing),
                               fmt::format("domain.min_m=[{:.17g},0.0]", -slab),
                               fmt::format("bodies.0.min_m=[{:.17g},0.0]", -slab)};
    for (const char* box : {"domain", "bodies.0"})
      overrides.push_back(fmt::format("{}.max_m=[{:.17g},{:.17g}]", box, 1 + slab, height));
    overrides.push_back(fmt::format("bodies.1.max_m=[1.0,{:.17g}]", height));
    const auto simulation = start(setting, overrides, "own_solid.toml");
    const Instant end = follow(*simulation, flow, {time}).back();
    rows.push_back(
        limit_row(fmt::format("nu t/H^2 {}, between its own solid: whole profile, L2 over the maximum", time),
                  end.whole, 0.01, {fmt::format("H/dx {}", count), watch.seconds(), "series solution"}));
    scales.push_back(spacing);
  }
  Rows series;
  add_series(series, scales, rows);
  return series;
}

}  // namespace

Rows poiseuille_startup(const Setting& setting) {
  const scene::Scene scene = scene::read_case(setting.folder / "case.toml");
  const double viscosity = scene.material.viscosity(400) / scene.material.density;
  const Flow flow{poiseuille, -scene.domain.gravity / (8 * viscosity), 0.01};
  Rows rows = run(setting, flow);
  for (const Row& row : between_own_solid(setting, flow)) rows.push_back(row);
  return rows;
}

Rows couette_startup(const Setting& setting) {
  const scene::Scene scene = scene::read_case(setting.folder / "case.toml");
  return run(setting, {couette, scene.domain.faces[1].velocity[1], 0.002});
}

}  // namespace meltray::app
