// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "app/validate/scenes.hpp"
#include "meltray/scene/elastic.hpp"

namespace meltray::app {
namespace {

constexpr double kHeating = 100;  // [K] above the temperature without stress

/// Mean stresses of the block, and how far single particles are from their mean [Pa].
struct Stress {
  double x = 0, y = 0, z = 0, spread = 0;
  double volume = 0;  ///< relative change, from the density
  double seconds = 0;
};

Stress run(const Setting& setting, const scene::Overrides& walls, int across) {
  const Watch watch;
  scene::Overrides set = walls;
  set.push_back(fmt::format("domain.spacing_m={}", 1e-3 / across));
  const auto simulation = start(setting, set);
  const scene::Scene& scene = simulation->scene();
  const terms::ElasticSolid solid = scene::elastic_solid(scene);
  terms::SceneConstants k;
  k.density = scene.material.density;
  k.material = scene.material;
  const double before = solid.reference_density(k, scene.heat.initial_temperature);
  advance(*simulation, scene.time.end);

  const Particles& p = simulation->particles();
  Stress mean;
  std::vector<double> stress_x;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_wall(i)) continue;
    const double pressure = solid.pressure(p.density[i], solid.reference_density(k, p.temperature[i]));
    const double sx = p.stress[0][i], sz = p.stress[2][i];
    stress_x.push_back(sx - pressure);
    mean.x += sx - pressure;
    mean.z += sz - pressure;
    mean.y += -sx - sz - pressure;
    mean.volume += before / p.density[i] - 1;
  }
  const auto n = static_cast<double>(stress_x.size());
  for (double* sum : {&mean.x, &mean.y, &mean.z, &mean.volume}) *sum /= n;
  for (const double s : stress_x) mean.spread = std::max(mean.spread, std::abs(s - mean.x));
  mean.seconds = watch.seconds();
  return mean;
}

}  // namespace

Rows constrained_expansion(const Setting& setting) {
  const int across = setting.small ? 10 : 20;
  const Material m = start(setting)->scene().material;
  const double nu = m.poisson_ratio, strain = m.linear_expansion_solid * kHeating,
               uniaxial = -m.youngs_modulus * strain;
  const auto wall = [](const char* face) {
    return scene::Overrides{fmt::format("faces.{}.kind=wall", face), fmt::format("faces.{}.slip=slip", face)};
  };
  scene::Overrides sides, all;
  for (const char* face : {"x_min", "x_max"})
    for (const auto& set : wall(face)) sides.push_back(set);
  all = sides;
  for (const char* face : {"z_min", "z_max"})
    for (const auto& set : wall(face)) all.push_back(set);

  Rows rows;
  const auto how = [&](const Stress& s, const char* source) {
    return Measured{fmt::format("{} across", across), s.seconds, source};
  };
  const Stress held = run(setting, all, across);
  const Measured full = how(held, "-E alpha dT / (1 - 2 nu)");
  rows.push_back(relative_row("held all round: sigma_x [Pa]", held.x, uniaxial / (1 - 2 * nu), 0.01, full));
  rows.push_back(relative_row("held all round: sigma_y [Pa]", held.y, uniaxial / (1 - 2 * nu), 0.01, full));
  const Stress between = run(setting, sides, across);
  const Measured biaxial = how(between, "-E alpha dT / (1 - nu)");
  rows.push_back(
      relative_row("held in x and y: sigma_x [Pa]", between.x, uniaxial / (1 - nu), 0.01, biaxial));
  rows.push_back(
      relative_row("held in x and y: sigma_y [Pa]", between.y, uniaxial / (1 - nu), 0.01, biaxial));
  rows.push_back(limit_row("held in x and y: sigma_z over uniaxial", between.z / uniaxial, 0.01, biaxial));
  const Stress free = run(setting, {}, across);
  const Measured plane = how(free, "-E alpha dT; 2 (1 + nu) alpha dT");
  rows.push_back(relative_row("held in y: sigma_y [Pa]", free.y, uniaxial, 0.01, plane));
  rows.push_back(limit_row("held in y: largest sigma_x over uniaxial",
                           (std::abs(free.x) + free.spread) / std::abs(uniaxial), 0.01, plane));
  rows.push_back(
      relative_row("held in y: change of volume", free.volume, 2 * (1 + nu) * strain, 0.01, plane));
  return rows;
}

}  // namespace meltray::app
