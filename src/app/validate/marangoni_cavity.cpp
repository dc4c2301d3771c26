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
  double profile = 0;             ///< L2 of the error, farther than 4 spacings from floor and surface
  double surface = 0, least = 0;  ///< speed at the surface and fastest back
  double seconds = 0;
};

/// Stress along the surface [Pa], towards the cold wall x_max.
double stress(const scene::Scene& scene) {
  const auto& [hot, cold] = std::pair{scene.domain.faces[0].temperature, scene.domain.faces[1].temperature};
  return scene.material.sigma_slope(0.5 * (hot + cold)) * (cold - hot) /
         (scene.domain.max[0] - scene.domain.min[0]);
}

/// As the steady flow leaves it, so that the layer need not swing to rest: temperature linear between the end
/// walls, core flow, and the surface inclined about its middle so that its weight holds the pressure of the
/// return flow, dp/dx = 3/2 tau / h.
void start_inclined(scene::Simulation& simulation) {
  const scene::Scene& scene = simulation.scene();
  const auto& faces = scene.domain.faces;
  const double length = scene.domain.max[0] - scene.domain.min[0],
               slope = 1.5 * stress(scene) / (scene.material.density * scene.domain.gravity);
  const double speed = stress(scene) / scene.material.viscosity(400);
  Particles& p = simulation.particles();
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_wall(i)) continue;
    // To where the depth integrated along x, 1 + slope (x - length / 2), is the former x: no volume changes.
    const double shallow = 1 - 0.5 * slope * length, former = p.x[0][i];
    const double x = 2 * former / (shallow + std::sqrt(shallow * shallow + 2 * slope * former));
    p.x[0][i] = x;
    p.v[0][i] = speed * core(p.x[1][i]);
    p.x[1][i] *= shallow + slope * x;
    p.temperature[i] = faces[0].temperature + x / length * (faces[1].temperature - faces[0].temperature);
    p.h[i] = scene.material.enthalpy(p.temperature[i]);
  }
}

/// Mean over looks and over the middle fifth of the length of u / (tau h / mu) at heights above the floor.
class Profile {
 public:
  explicit Profile(double spacing) : spacing_(spacing) {
    for (int k = 0; k < kHeights; ++k)
      heights_.push_back(2 * spacing + (1 - 4 * spacing) * k / (kHeights - 1));
    heights_.push_back(1);
    sums_.resize(heights_.size());
  }

  void look(const scene::Simulation& simulation) {
    const scene::Scene& scene = simulation.scene();
    const double length = scene.domain.max[0] - scene.domain.min[0];
    const double scale = stress(scene) / scene.material.viscosity(400);  // depth 1
    const Particles& p = simulation.particles();
    for (std::size_t k = 0; k < heights_.size(); ++k)
      for (const double x : {0.42, 0.46, 0.5, 0.54, 0.58})
        sums_[k] += sample(p, {x * length, heights_[k], 0}, 4 * spacing_,
                           [&](std::size_t i) { return p.v[0][i] / scale; });
    count_ += 5;
  }

  Layer result() const {
    Layer out;
    double square = 0, inside = 0;
    for (int k = 0; k < kHeights; ++k) {
      const double z = heights_[k], u = sums_[k] / count_, away = 4 * spacing_;
      out.least = std::min(out.least, u);
      if (z < away || z > 1 - away) continue;
      square += std::pow(u - core(z), 2);
      ++inside;
    }
    out.profile = std::sqrt(square / inside);
    out.surface = sums_.back() / count_;
    return out;
  }

 private:
  static constexpr int kHeights = 81;
  double spacing_;
  std::vector<double> heights_, sums_;  ///< the last one is the surface
  double count_ = 0;
};

/// Mean over the run from when it has forgotten its start.
Layer run(const Setting& setting, double spacing) {
  constexpr double kUp = 1;  // twice the time depth^2 / ((pi / 2)^2 nu) in which the slowest mode decays
  constexpr int kLooks = 40;
  const Watch watch;
  const auto simulation = start(setting, {fmt::format("domain.spacing_m={:.17g}", spacing)});
  start_inclined(*simulation);
  const double end = simulation->scene().time.end;
  Profile profile(spacing);
  for (int look = 1; look <= kLooks; ++look) {
    advance(*simulation, kUp + (end - kUp) * look / kLooks);
    profile.look(*simulation);
  }
  Layer out = profile.result();
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
