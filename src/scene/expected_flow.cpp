// SPDX-License-Identifier: MIT
#include "meltray/scene/expected_flow.hpp"

#include <algorithm>
#include <cmath>

namespace meltray::scene {

namespace {

/// The front of a capillary is this much hotter than the boiling point [K]; an assumption, from welds with
/// the absorbed intensity of a 0.2 mm spot at 2 kW.
constexpr double kOverheat = 300;

}  // namespace

double expected_speed(const Scene& scene) {
  const Domain& domain = scene.domain;
  double speed = std::abs(domain.velocity_scale);
  for (const Body& body : domain.bodies) speed = std::max(speed, body.velocity.norm());
  for (const Face& face : domain.faces) speed = std::max(speed, face.velocity.norm());
  const double rho = scene.material.density, height = (domain.max - domain.min)[domain.dimension - 1];
  if (scene.terms.gravity) speed = std::max(speed, std::sqrt(domain.gravity * height));
  speed = std::max(speed, std::sqrt(2 * scene.surface.recoil_pressure / rho));
  if (scene.terms.surface_tension)
    speed =
        std::max(speed, std::sqrt(scene.material.sigma(scene.material.liquidus) / (rho * domain.spacing)));
  return speed > 0 ? speed : 1.0;
}

double expected_pressure(const Scene& scene) {
  if (!scene.terms.recoil) return 0;
  if (scene.surface.recoil_pressure > 0) return scene.surface.recoil_pressure;
  const Material& m = scene.material;
  return scene.surface.recoil_coefficient * m.saturation_pressure(m.boiling_temperature + kOverheat);
}

double default_sound_speed(const Scene& scene) {
  return kSoundOverFlow *
         std::max(expected_speed(scene), std::sqrt(expected_pressure(scene) / scene.material.density));
}

}  // namespace meltray::scene
