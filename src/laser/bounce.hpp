// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "laser/polarisation.hpp"
#include "meltray/laser/laser.hpp"

namespace meltray::laser {

/// A point of the mesh that a ray has hit.
struct SurfacePoint {
  Vec3 position;
  Vec3 flat_normal;    ///< unit normal of the triangle
  Vec3 smooth_normal;  ///< unit, interpolated between the vertices
  bool liquid;         ///< of the nearest vertex

  /// Barycentric coordinates u, v belong to the second and third corner.
  static SurfacePoint on(const SurfaceMesh& mesh, std::size_t triangle, double u, double v);
};

/// The optical state of one ray from bounce to bounce.
class Bounce {
 public:
  Bounce(const TraceOptions& options, const Vec3& direction, std::size_t ray_number);
  /// Turns `direction` into that of the reflected ray, which leaves the triangle; returns the absorptance.
  double reflect(const SurfacePoint& point, Vec3& direction);

 private:
  double absorb_averaged(const SurfacePoint& point, double cosine) const;
  double absorb_tracked(const SurfacePoint& point, const Vec3& in, const Vec3& normal, const Vec3& out);
  Vec3 diffuse(const SurfacePoint& point);
  double uniform();

  const TraceOptions& options_;
  PolarisationState polarisation_;
  std::uint64_t random_;
};

}  // namespace meltray::laser
