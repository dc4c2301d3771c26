// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/laser/laser.hpp"

namespace meltray::laser::testing {

/// Adds the parallelogram a, a + u, a + u + v, a + v with its own flat normal u x v.
inline void add_facet(SurfaceMesh& mesh, const Vec3& a, const Vec3& u, const Vec3& v) {
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  const Vec3 normal = u.cross(v).normalized();
  for (const Vec3& corner : {a, Vec3(a + u), Vec3(a + u + v), Vec3(a + v)}) {
    mesh.vertices.push_back(corner);
    mesh.normals.push_back(normal);
    mesh.liquid.push_back(0);
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// Horizontal square plate of half-width `half` at z = 0, metal below.
inline SurfaceMesh plate(double half) {
  SurfaceMesh mesh;
  add_facet(mesh, {-half, -half, 0}, {2 * half, 0, 0}, {0, 2 * half, 0});
  return mesh;
}

/// Groove along y with its tip at the origin and walls at `half_angle` [rad] to the vertical, 1 mm deep.
inline SurfaceMesh wedge(double half_angle) {
  const double depth = 1e-3, length = 1e-2;
  const double x = std::sin(half_angle) * depth, z = std::cos(half_angle) * depth;
  SurfaceMesh mesh;
  add_facet(mesh, {0, -length / 2, 0}, {x, 0, z}, {0, length, 0});
  add_facet(mesh, {0, -length / 2, 0}, {0, length, 0}, {-x, 0, z});
  return mesh;
}

}  // namespace meltray::laser::testing
