// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "app/validate/cases.hpp"
#include "app/validate/diffuse_cavity.hpp"
#include "app/validate/optics.hpp"
#include "meltray/core/constants.hpp"

namespace meltray::app {
namespace {

constexpr int kAround = 128;  ///< facets around the axis; their chords miss 1e-4 of the area

/// Walls of a cavity of revolution as flat facets, seen from inside.
laser::SurfaceMesh facets(const CavityProfile& profile) {
  laser::SurfaceMesh mesh;
  for (std::size_t k = 1; k < profile.size(); ++k) {
    const Circle &low = profile[k - 1], &high = profile[k];
    const double dr = high.radius - low.radius, dz = high.z - low.z, length = std::hypot(dr, dz);
    for (int a = 0; a < kAround; ++a) {
      const double from = 2 * constants::pi * a / kAround, to = 2 * constants::pi * (a + 1) / kAround;
      const Vec3 u(std::cos(from), std::sin(from), 0), v(std::cos(to), std::sin(to), 0);
      const Vec3 normal = (-dz * (u + v).normalized() + dr * Vec3::UnitZ()) / length;
      const auto first = static_cast<std::int32_t>(mesh.vertices.size());
      for (const Vec3& corner : {Vec3(low.radius * u), Vec3(low.radius * v)})
        mesh.vertices.push_back(corner + low.z * Vec3::UnitZ());
      for (const Vec3& corner : {Vec3(high.radius * v), Vec3(high.radius * u)})
        mesh.vertices.push_back(corner + high.z * Vec3::UnitZ());
      mesh.normals.insert(mesh.normals.end(), 4, normal);
      if (low.radius > 0) mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first, first + 2, first + 3});
    }
  }
  return mesh;
}

/// Rays along -z that fill the opening evenly (a spiral in steps of the golden angle).
std::vector<laser::Ray> rays_into(const CavityProfile& profile, int count) {
  const Circle rim = profile.back();
  std::vector<laser::Ray> rays;
  for (int k = 0; k < count; ++k) {
    const double r = 0.9999 * rim.radius * std::sqrt((k + 0.5) / count), angle = 2.399963229728653 * k;
    rays.push_back({{r * std::cos(angle), r * std::sin(angle), 2 * rim.z}, {0, 0, -1}, 1.0 / count});
  }
  return rays;
}

struct Cavity {
  std::string name;
  CavityProfile profile;
};

constexpr std::array kWalls = {0.34, 0.06};

/// The scatter of the rays is 0.5 / sqrt(count) at most: four times that, and the width of the bands.
double line(int count) {
  return 2 / std::sqrt(count) + 1e-3;
}

/// Share of axis-parallel light that matt walls take up.
double traced(const CavityProfile& profile, double wall, int count, double& worst_ledger) {
  laser::Tracer tracer;
  tracer.set_mesh(facets(profile));
  laser::TraceOptions options;
  options.diffuse = true;
  options.fixed_absorptance = wall;
  const auto ledger = tracer.trace(rays_into(profile, count), options).ledger;
  worst_ledger = std::max(worst_ledger, ledger_error(ledger));
  return (ledger.absorbed + ledger.residual) / ledger.in;
}

}  // namespace

Rows gouffe_cavity(const Setting& setting) {
  const int count = setting.small ? 10000 : 100000;
  std::vector<Cavity> cavities;
  const std::vector<int> ratios = setting.small ? std::vector<int>{2} : std::vector<int>{1, 2, 3, 5, 10};
  for (const int ratio : ratios) {
    cavities.push_back({fmt::format("cylinder, L/d {}", ratio), cylinder(ratio, 1)});
    cavities.push_back({fmt::format("cone, L/d {}", ratio), cone(ratio, 1)});
  }
  Rows rows;
  double worst_ledger = 0;
  // A quarter of what leaves any point of the sphere's wall goes through its opening, a quarter of the whole
  // sphere.
  const CavityProfile open_sphere = sphere(1, 0.75);
  for (const double wall : kWalls) {
    const Watch watch;
    const double share = traced(open_sphere, wall, count, worst_ledger);
    rows.push_back(absolute_row(fmt::format("sphere, 3/4 high, A0 {}: absorptance", wall), share,
                                wall / (1 - 0.75 * (1 - wall)), line(count),
                                {fmt::format("{} rays", count), watch.seconds(), "exact"}));
  }
  for (const Cavity& cavity : cavities)
    for (const double wall : kWalls) {
      const Watch watch;
      const double share = traced(cavity.profile, wall, count, worst_ledger);
      const Measured how{fmt::format("{} rays", count), watch.seconds(), "radiosity of 400 bands"};
      rows.push_back(absolute_row(fmt::format("{}, A0 {}: absorptance", cavity.name, wall), share,
                                  radiosity_absorptance(cavity.profile, wall), line(count), how));
      if (!setting.small)
        rows.push_back(relative_row(fmt::format("Gouffe: {}, A0 {}", cavity.name, wall), share,
                                    gouffe_absorptance(cavity.profile, wall), 0.03,
                                    {how.resolution, how.seconds, "Gouffe 1945"}));
    }
  rows.push_back(limit_row("ledger of the traces", worst_ledger, 1e-9, {"", 0, "energy balance"}));
  return rows;
}

}  // namespace meltray::app
