// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "app/validate/scenes.hpp"
#include "app/validate/table.hpp"

namespace meltray::app {
namespace {

constexpr double kStefan = 0.041;
/// Until then the wall of the experiment was becoming hot: the small twin is judged from here on.
constexpr double kWallHot = 0.01;
/// From here on the melt circulates fast enough for the front to lean.
constexpr double kOrdered = 0.013;

/// Molten length of the rows within a spacing of a height, in parts too.
double front(const scene::Simulation& simulation, double height) {
  const scene::Scene& scene = simulation.scene();
  const Particles& p = simulation.particles();
  double molten = 0, whole = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_wall(i) || std::abs(p.x[1][i] - height) > scene.domain.spacing) continue;
    molten += scene.material.liquid_fraction(p.h[i]);
    ++whole;
  }
  return molten / whole;
}

double liquid_share(const scene::Simulation& simulation) {
  const Particles& p = simulation.particles();
  double molten = 0, whole = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_wall(i)) continue;
    molten += simulation.scene().material.liquid_fraction(p.h[i]);
    ++whole;
  }
  return molten / whole;
}

struct Sample {
  double tau, top, centre, bottom, fraction;
};

/// The record at another time, linear in between.
double at(const std::vector<Sample>& record, double Sample::*what, double tau) {
  std::size_t k = 1;
  while (k + 1 < record.size() && record[k].tau < tau) ++k;
  const Sample &a = record[k - 1], &b = record[k];
  return a.*what + (tau - a.tau) / (b.tau - a.tau) * (b.*what - a.*what);
}

std::vector<Sample> run(const Setting& setting, int across, double end, double& seconds) {
  const Watch watch;
  const double spacing = 1.0 / across, height = std::round(0.714 * across) * spacing;
  const auto simulation = start(setting, {fmt::format("domain.spacing_m={:.17g}", spacing),
                                          fmt::format("domain.max_m=[1.0,{:.17g}]", height),
                                          fmt::format("bodies.0.max_m=[1.0,{:.17g}]", height)});
  const Material& m = simulation->scene().material;
  const double scale = kStefan * m.conductivity_liquid(105) / (m.density * m.heat_capacity_liquid);
  std::vector<Sample> record{{0, 0, 0, 0, 0}};
  constexpr int kSamples = 100;
  for (int k = 1; k <= kSamples; ++k) {
    const double tau = end * k / kSamples;
    advance(*simulation, tau / scale);
    record.push_back({tau, front(*simulation, height), front(*simulation, 0.5 * height),
                      front(*simulation, 0), liquid_share(*simulation)});
  }
  seconds = watch.seconds();
  return record;
}

struct Curve {
  const char *name, *column;
  double Sample::*what;
  double line;  ///< 0: reported only
};

}  // namespace

Rows gallium_melting(const Setting& setting) {
  const Table table(setting.folder / "reference.csv");
  const std::vector<int> across = setting.small ? std::vector<int>{20} : std::vector<int>{30, 60};
  const double end = setting.small ? 0.022 : 0.065;
  Rows rows;
  for (const int count : across) {
    double seconds = 0;
    const auto record = run(setting, count, end, seconds);
    const Measured how{fmt::format("L/dx {}", count), seconds, table.source()};
    const bool judged = count == across.back();
    for (const Curve& curve :
         {Curve{"liquid share", "fraction", &Sample::fraction, 0.08},
          Curve{"front at the middle", "centre", &Sample::centre, setting.small ? 0 : 0.15},
          Curve{"front at the top", "top", &Sample::top, 0},
          Curve{"front at the bottom", "bottom", &Sample::bottom, 0}})
      for (std::size_t r = 0; r < table.rows(); ++r) {
        const double tau = table.number(r, "tau");
        if (table.text(r, "what") != curve.column || tau > end) continue;
        rows.push_back(relative_row(fmt::format("tau {}: {}", tau, curve.name), at(record, curve.what, tau),
                                    table.number(r, "value"), curve.line, how));
        rows.back().judged = judged && curve.line > 0 && (tau > kWallHot || !setting.small);
      }
    double worst = 0;  // how far the bottom is ahead of the middle or the middle of the top
    for (const Sample& s : record)
      if (s.tau > kOrdered) worst = std::max({worst, s.bottom - s.centre, s.centre - s.top});
    rows.push_back(limit_row("front leans: bottom ahead of middle ahead of top by", worst, 0, how));
    rows.back().judged = judged && !setting.small;
  }
  return rows;
}

}  // namespace meltray::app
