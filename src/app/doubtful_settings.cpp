// SPDX-License-Identifier: MIT
#include "app/doubtful_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "meltray/scene/body_bounds.hpp"
#include "meltray/scene/lattice_layers.hpp"

namespace meltray::app {
namespace {

using scene::Body, scene::Domain, scene::Scene, scene::ShapeKind;

// Part of a spacing by which the particles of a body may end before or beyond its face.
constexpr double kFaceOffset = 0.1;

/// Boxes whose faces lie between two layers of the lattice: their particles end elsewhere.
void faces_between_layers(const Domain& domain, std::vector<std::string>& found) {
  if (domain.arrangement == scene::Arrangement::rotated) return;
  constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
  for (std::size_t k = 0; k < domain.bodies.size(); ++k) {
    const Body& body = domain.bodies[k];
    if (body.shape != ShapeKind::box) continue;
    for (int c = 0; c < domain.dimension; ++c) {
      const double layer = scene::layer_height(domain, c);
      for (const auto& [name, face] : {std::pair{"min_m", body.min[c]}, {"max_m", body.max[c]}}) {
        if (face <= domain.min[c] || face >= domain.max[c]) continue;
        const double end = domain.min[c] + layer * std::round((face - domain.min[c]) / layer);
        if (std::abs(end - face) > kFaceOffset * domain.spacing)
          found.push_back(fmt::format(
              "bodies[{}].{}: {} = {:g} m lies between two layers of particles; they end at {:g} m", k, name,
              c == domain.dimension - 1 ? "z" : kAxes[c], face, end));
      }
    }
  }
}

}  // namespace

std::vector<std::string> doubtful_settings(const Scene& s) {
  std::vector<std::string> found;
  faces_between_layers(s.domain, found);
  if (!s.laser || s.domain.bodies.empty()) return found;
  double top = -1e300, end = -1e300;
  for (const Body& body : s.domain.bodies) {
    const Vec3 max = scene::bounds_of(body).max.cwiseMin(s.domain.max);
    top = std::max(top, max[2]);
    end = std::max(end, max[0]);
  }
  if (std::abs(top) > s.domain.spacing)
    found.push_back(
        fmt::format("the top of the bodies is at z = {:g} m; depths are measured from z = 0", top));
  constexpr double kHeadRoom = 5;  // spacings
  if (s.domain.max[2] - top < kHeadRoom * s.domain.spacing)
    found.push_back(
        fmt::format("domain.max_m: {:g} m above the bodies; less than {:g} spacings, in which melt and light "
                    "find no free surface",
                    s.domain.max[2] - top, kHeadRoom));
  const double last =
      s.laser->beam.start_x + s.laser->beam.feed * std::min(s.time.end, s.laser->beam.off_time);
  if (last > end)
    found.push_back(
        fmt::format("the beam leaves the bodies: it ends at x = {:g} m, they at {:g} m", last, end));
  const Material& m = s.material;
  // Of metals that are welded, magnesium to tungsten, with a margin.
  const std::array<std::tuple<const char*, double, double, double>, 3> usual = {
      {{"density_kg_m3", m.density, 1e3, 2.5e4},
       {"heat_capacity_solid_j_kg_k", m.heat_capacity_solid, 100, 3000},
       {"heat_capacity_liquid_j_kg_k", m.heat_capacity_liquid, 100, 3000}}};
  for (const auto& [name, value, low, high] : usual)
    if (value < low || value > high)
      found.push_back(fmt::format("material.{}: {:g}; metals have {:g} to {:g}", name, value, low, high));
  return found;
}

}  // namespace meltray::app
