// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "meltray/scene/body_bounds.hpp"
#include "scene/case_check.hpp"
#include "scene/keys.hpp"

namespace meltray::scene {

namespace {

/// Particles are numbered by 32-bit integers.
constexpr double kMaxParticles = 2147483647.0;

/// Name of a component: a 2-D scene has x and z.
const char* name_of(const Domain& domain, int component) {
  constexpr const char* names[] = {"x", "y", "z"};
  return names[domain.dimension == 2 ? 2 * component : component];
}

void check_extent(const Document& document, const Scene& scene, const std::string& section, const Vec3& min,
                  const Vec3& max) {
  for (int a = 0; a < scene.domain.dimension; ++a)
    if (!(min[a] < max[a]))
      refuse(document.place(section + ".max_m"), section + ".max_m",
             fmt::format("{} in {} where min_m is {}", max[a], name_of(scene.domain, a), min[a]),
             "max_m > min_m");
}

void check_faces(const Scene& scene, const Document& document) {
  const Domain& d = scene.domain;
  for (int f = 0; f < 6; ++f) {
    const bool plane = d.dimension == 2;
    const int axis = plane && f >= 4 ? 1 : f / 2, other = f ^ 1;
    const auto& face = d.faces[static_cast<std::size_t>(f)];
    if ((plane && f / 2 == 1) || face.kind != FaceKind::periodic) continue;
    const std::string key = path_of("faces.*.kind", f);
    if (d.faces[static_cast<std::size_t>(other)].kind != FaceKind::periodic)
      refuse(document.place(key), key, "\"periodic\" on one side only",
             fmt::format("periodic on both sides: {} as well", path_of("faces.*.kind", other)));
    const double cells = (d.max[axis] - d.min[axis]) / d.spacing;
    if (std::abs(cells - std::round(cells)) > 1e-6 * cells)
      refuse(document.place("domain.spacing_m"), "domain.spacing_m",
             fmt::format("{}, which divides the periodic length in {} into {} parts", d.spacing,
                         name_of(d, axis), cells),
             "a spacing that divides it into a whole number");
  }
}

void check_body(const Scene& scene, const Document& document, int index) {
  const Domain& d = scene.domain;
  const Body& body = d.bodies[static_cast<std::size_t>(index)];
  const std::string section = path_of("bodies.*", index);
  const bool box = body.shape == ShapeKind::box;
  const std::string key = section + (box ? ".max_m" : ".radii_m");
  if (box) check_extent(document, scene, section, body.min, body.max);
  const auto [min, max] = bounds_of(body);
  for (int a = 0; a < d.dimension; ++a) {
    if (max[a] <= d.min[a] || min[a] >= d.max[a])
      refuse(document.place(key), key, fmt::format("a body outside the domain in {}", name_of(d, a)),
             fmt::format("a body that overlaps {} to {} m", d.min[a], d.max[a]));
    if (max[a] - min[a] < d.spacing * (1 - 1e-9))
      refuse(document.place(key), key,
             fmt::format("{} m in {}, thinner than one particle", max[a] - min[a], name_of(d, a)),
             fmt::format("at least domain.spacing_m = {} m", d.spacing));
  }
}

}  // namespace

void check_geometry(const Scene& scene, const Document& document) {
  const Domain& d = scene.domain;
  check_extent(document, scene, "domain", d.min, d.max);
  double particles = 1;
  for (int a = 0; a < d.dimension; ++a) {
    const double length = d.max[a] - d.min[a];
    if (length < d.spacing)
      refuse(document.place("domain.spacing_m"), "domain.spacing_m",
             fmt::format("{} where the domain is {} m long in {}", d.spacing, length, name_of(d, a)),
             "less than the domain");
    particles *= length / d.spacing;
  }
  if (particles > kMaxParticles)
    refuse(document.place("domain.spacing_m"), "domain.spacing_m",
           fmt::format("{}, room for {:.3g} particles", d.spacing, particles),
           fmt::format("a spacing for at most {:.3g} particles", kMaxParticles));
  if (d.arrangement == Arrangement::jittered && d.jitter == 0)
    refuse(document.place("domain.arrangement"), "domain.arrangement", "\"jittered\" with domain.jitter = 0",
           "a domain.jitter > 0");
  if (d.velocity_field != VelocityField::none && d.velocity_scale == 0)
    refuse(document.place("domain.velocity_field"), "domain.velocity_field",
           "a velocity field with domain.velocity_scale_m_s = 0", "a domain.velocity_scale_m_s > 0");
  check_faces(scene, document);
  if (d.bodies.empty()) refuse(document.place("bodies"), "bodies", "no body", "at least one [[bodies]]");
  for (int b = 0; b < static_cast<int>(d.bodies.size()); ++b) check_body(scene, document, b);
}

}  // namespace meltray::scene
