// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "app/validate/cases.hpp"
#include "app/validate/optics.hpp"
#include "app/validate/table.hpp"
#include "meltray/core/constants.hpp"

namespace meltray::app {
namespace {

constexpr double kDegree = constants::pi / 180;
constexpr double kSide = 1e-3;  ///< length of a wall, tip to rim [m]

struct Optics {
  const char* column;
  const char* name;
  std::complex<double> index;
  laser::Polarisation polarisation;
};

const std::array<Optics, 4> kOptics = {
    {{"fe_tracked", "Fe tracked", kIron, laser::Polarisation::tracked},
     {"fe_averaged", "Fe averaged", kIron, laser::Polarisation::averaged},
     {"al_tracked", "Al tracked", kAluminium, laser::Polarisation::tracked},
     {"al_averaged", "Al averaged", kAluminium, laser::Polarisation::averaged}}};

/// Rays along -z that fill the opening of a wedge, except for a strip |x| < skip around the axis.
std::vector<laser::Ray> rays_into(double half_angle, double skip, int count) {
  const double half_width = kSide * std::sin(half_angle);
  std::vector<laser::Ray> rays;
  for (int i = 0; i < count; ++i) {
    const double x = half_width * (2 * (i + 0.5) / count - 1);
    // Rays lie at many places along the groove, so that they see all of a rough surface.
    const double y = 0.2 * kSide * (std::fmod(0.6180339887498949 * i, 1.0) - 0.5);
    if (std::abs(x) >= skip) rays.push_back({{x, y, 2 * kSide}, {0, 0, -1}, 1.0 / count});
  }
  return rays;
}

/// Two flat walls with their common edge along y at the origin, opening upwards.
laser::SurfaceMesh facets(double half_angle) {
  laser::SurfaceMesh mesh;
  for (const double side : {1.0, -1.0}) {
    const auto first = static_cast<std::int32_t>(mesh.vertices.size());
    const Vec3 up = 1.01 * kSide * Vec3(side * std::sin(half_angle), 0, std::cos(half_angle));
    const Vec3 along(0, kSide, 0), normal(-side * std::cos(half_angle), 0, std::sin(half_angle));
    for (const Vec3& corner : {Vec3(-along), Vec3(along), Vec3(along + up), Vec3(up - along)}) {
      mesh.vertices.push_back(corner);
      mesh.normals.push_back(normal);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

/// Metal around a wedge: on each side of the plane of symmetry a lattice whose layers follow the wall. The
/// walls go on beyond kSide by three spacings, which no axis-parallel ray meets.
laser::SurfaceMesh particle_wedge(double half_angle, double spacing) {
  Cloud cloud;
  cloud.spacing = spacing;
  const double rim = kSide + 3 * spacing;
  const laser::Box region{
      {-rim * std::sin(half_angle) - 5 * spacing, -0.2 * kSide, -6 * spacing},
      {rim * std::sin(half_angle) + 5 * spacing, 0.2 * kSide, rim * std::cos(half_angle) + 5 * spacing}};
  const double out = 4 * spacing, top = rim * std::cos(half_angle);
  const int ny = static_cast<int>(std::ceil((0.2 * kSide + out) / spacing));
  const int reach = static_cast<int>(std::ceil((region.max - region.min).norm() / spacing)) + 8;
  for (const double side : {1.0, -1.0})
    for (int k = 0; k < reach; ++k)
      for (int i = -reach; i < reach; ++i) {
        const double t = (i + 0.5) * spacing, depth = (k + 0.5) * spacing;
        const double x = t * std::sin(half_angle) + depth * std::cos(half_angle);
        const double z = t * std::cos(half_angle) - depth * std::sin(half_angle);
        if (x < 0 || x > region.max[0] + out || z < region.min[2] - out || z > top) continue;
        for (int j = -ny; j < ny; ++j) cloud.add({side * x, (j + 0.5) * spacing, z});
      }
  return laser::reconstruct_surface(cloud.view(), region);
}

struct Result {
  double share;  ///< absorbed and residual power over that of the rays
  double ledger;
};

Result absorbed(const laser::Tracer& tracer, const std::vector<laser::Ray>& rays, const Optics& optics) {
  const auto ledger = tracer.trace(rays, metal(optics.index, optics.polarisation)).ledger;
  return {(ledger.absorbed + ledger.residual) / ledger.in, ledger_error(ledger)};
}

}  // namespace

Rows wedge_absorption(const Setting& setting) {
  const Table table(setting.folder / "reference.csv");
  Rows rows;
  double worst_ledger = 0;
  laser::Tracer tracer;
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const double degrees = table.number(r, "half_angle_deg");
    tracer.set_mesh(facets(degrees * kDegree));
    for (const Optics& optics : kOptics) {
      const Watch watch;
      const Result result = absorbed(tracer, rays_into(degrees * kDegree, 0, 4000), optics);
      worst_ledger = std::max(worst_ledger, result.ledger);
      rows.push_back(absolute_row(fmt::format("{}: flat facets, {} deg", optics.name, degrees), result.share,
                                  table.number(r, optics.column), 1e-3,
                                  {"", watch.seconds(), table.source()}));
    }
  }
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const double degrees = table.number(r, "half_angle_deg");
    // The small twin takes the widest wedge only.
    if (degrees > 45 || degrees < (setting.small ? 45 : 15)) continue;
    std::array<double, 4> coarse{};
    for (const int per_side : {10, 20}) {
      const Watch watch;
      const double spacing = kSide / per_side;
      tracer.set_mesh(particle_wedge(degrees * kDegree, spacing));
      for (std::size_t o = 0; o < kOptics.size(); ++o) {
        const Result result = absorbed(tracer, rays_into(degrees * kDegree, spacing, 20000), kOptics[o]);
        worst_ledger = std::max(worst_ledger, result.ledger);
        Row row = relative_row(fmt::format("{}: wedge of particles, {} deg", kOptics[o].name, degrees),
                               result.share, table.number(r, kOptics[o].column), 0.02,
                               {fmt::format("{} a side", per_side), watch.seconds(), table.source()});
        row.goal = 0.01;
        row.judged = per_side == 20;
        if (row.judged)
          row.order = observed_order(coarse[o], row.error, 2);
        else
          coarse[o] = row.error;
        rows.push_back(row);
      }
    }
  }
  rows.push_back(limit_row("ledger of the traces", worst_ledger, 1e-9, {"", 0, "energy balance"}));
  return rows;
}

}  // namespace meltray::app
