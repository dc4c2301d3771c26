// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "meltray/core/vec.hpp"
#include "meltray/particles/particles.hpp"

namespace meltray::observe {

/// Coordinates of a particle in x, y, z whatever the dimension (2-D: the x-z plane, y = 0).
inline Vec3 position(const Particles& p, std::size_t i) {
  return p.dim == 3 ? Vec3(p.x[0][i], p.x[1][i], p.x[2][i]) : Vec3(p.x[0][i], 0, p.x[1][i]);
}
inline Vec3 velocity(const Particles& p, std::size_t i) {
  return p.dim == 3 ? Vec3(p.v[0][i], p.v[1][i], p.v[2][i]) : Vec3(p.v[0][i], 0, p.v[1][i]);
}

/// Material of the scene: neither dummy of a wall nor removed.
inline bool is_material(const Particles& p, std::size_t i) {
  return !p.is_wall(i) && !p.has(i, kRemoved);
}

/// The connected melt around the beam. Lengths [m]; each particle counts with its spacing. Melt that goes on
/// through a periodic face is cut there.
struct Pool {
  bool exists = false;
  double length = 0;                            ///< along x
  double width = 0;                             ///< along y; 0 in 2-D
  double depth = 0;                             ///< below the workpiece top z = 0
  double top = 0;                               ///< highest point (z)
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();  ///< box of the particle centres
  std::size_t particles = 0;
};

/// Clusters liquid particles that are closer than 1.5 spacings and takes the largest cluster that comes
/// within `reach` of the vertical line through `beam` (without a beam or such a cluster: the largest): drops
/// in flight and droplets on the surface are other clusters.
Pool measure_pool(const Particles& p, double spacing, std::optional<Vec3> beam, double reach);

/// Highest point of the material that is no spatter: the pool and the solid [m].
double top_surface(const Particles& p, double spacing, const Pool& pool);

/// Cross-section of the re-solidified seam at one place along the feed.
struct SeamSection {
  double x = 0;      ///< centre of the section [m]
  double depth = 0;  ///< below z = 0 [m]
  double width = 0;  ///< along y [m]; 0 in 2-D
  double top = 0;    ///< highest re-solidified point (z) [m]
  std::size_t particles = 0;
};

/// Sections one spacing long through the re-solidified particles. Clusters of fewer than 20 of them are
/// frozen spatter and left out.
std::vector<SeamSection> measure_seam(const Particles& p, double spacing);

/// Label of the cluster of each entry of `selected` (links shorter than `link`), numbered from 0 in order of
/// their first member.
std::vector<std::int32_t> clusters(const Particles& p, const std::vector<std::int32_t>& selected,
                                   double link);

}  // namespace meltray::observe
