// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "app/validate/sampling.hpp"
#include "app/validate/scenes.hpp"

namespace meltray::app {
namespace {

/// Core of a shallow layer under a surface stress: u = (tau h / mu)(3/4 z^2 - 1/2 z), z over the depth h (Sen
/// & Davis 1982, limit of a long cavity at rest).
double core(double z) {
  return 0.75 * z * z - 0.5 * z;
}

struct Layer {
  double profile = 0;  ///< L2 of the error over the middle tenth, farther than 3 h from floor and surface
  double surface = 0, least = 0;  ///< speed at the surface and smallest of the core
  double seconds = 0;
};

/// Stress along the surface [Pa], towards the cold wall x_max.
double stress(const scene::Scene& scene) {
  const auto& [hot, cold] = std::pair{scene.domain.faces[0].temperature, scene.domain.faces[1].temperature};
  return scene.material.sigma_slope(0.5 * (hot + cold)) * (cold - hot) /
         (scene.domain.max[0] - scene.domain.min[0]);
}

/// Temperature linear between the end walls, as conduction would leave it.
void start_linear(scene::Simulation& simulation) {
  const scene::Scene& scene = simulation.scene();
  const auto& faces = scene.domain.faces;
  Particles& p = simulation.particles();
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_wall(i)) continue;
    const double share = (p.x[0][i] - scene.domain.min[0]) / (scene.domain.max[0] - scene.domain.min[0]);
    p.temperature[i] = faces[0].temperature + share * (faces[1].temperature - faces[0].temperature);
    p.h[i] = scene.material.enthalpy(p.temperature[i]);
  }
}

/// Speeds over tau h / mu, mean of ten looks over the last quarter of the run.
Layer run(const Setting& setting, double spacing) {
  const Watch watch;
  const auto simulation = start(setting, {fmt::format("domain.spacing_m={:.17g}", spacing)});
  start_linear(*simulation);
  const scene::Scene& scene = simulation->scene();
  const double length = scene.domain.max[0] - scene.domain.min[0];
  const double scale = stress(scene) / scene.material.viscosity(400);  // depth 1
  const Particles& p = simulation->particles();
  constexpr int kLooks = 10;
  Layer out;
  double square = 0, count = 0;
  for (int look = 1; look <= kLooks; ++look) {
    advance(*simulation, scene.time.end * (0.75 + 0.25 * look / kLooks));
    for (std::size_t i = 0; i < p.size(); ++i) {
      const double z = p.x[1][i], away = 3 * p.smoothing[i];
      if (p.is_wall(i) || std::abs(p.x[0][i] - 0.5 * length) > 0.05 * length || z < away || z > 1 - away)
        continue;
      square += std::pow(p.v[0][i] / scale - core(z), 2);
      ++count;
    }
    const auto speed = [&](double z) {
      return sample(p, {0.5 * length, z, 0}, 4 * spacing, [&](std::size_t i) { return p.v[0][i] / scale; });
    };
    out.surface += speed(1) / kLooks;
    out.least -= peak([&](double z) { return -speed(z); }, 2 * spacing, 1 - 2 * spacing, 41).value / kLooks;
  }
  out.profile = std::sqrt(square / count);
  out.seconds = watch.seconds();
  return out;
}

}  // namespace

Rows marangoni_cavity(const Setting& setting) {
  const std::vector<double> per_depth =
      setting.small ? std::vector<double>{10} : std::vector<double>{10, 20, 30};
  Rows profiles, surfaces, leasts, rows;
  std::vector<double> spacings;
  for (const double count : per_depth) {
    spacings.push_back(1 / count);
    const Layer layer = run(setting, spacings.back());
    const Measured how{fmt::format("h/dx {}", count), layer.seconds, "core flow of a long cavity"};
    // Of the surface value, which is core(1); the twin shows only that the layer is driven and returns.
    const double line = (setting.small ? 0.4 : 0.03) * core(1);
    profiles.push_back(limit_row("profile inside, L2, over tau h/mu", layer.profile, line, how));
    surfaces.push_back(
        absolute_row("speed of the surface, over tau h/mu", layer.surface, core(1), line, how));
    leasts.push_back(
        absolute_row("fastest return flow, over tau h/mu", layer.least, core(1.0 / 3), line, how));
  }
  add_series(rows, spacings, profiles);
  add_series(rows, spacings, surfaces);
  add_series(rows, spacings, leasts);
  return rows;
}

}  // namespace meltray::app
