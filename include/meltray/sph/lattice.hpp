// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/sph/kernel.hpp"

namespace meltray::sph {

/// Kernel sums over a full square or cubic lattice: what a particle deep inside material sees. Sums over real
/// neighbours are divided by these, so that "full" means 1 and missing neighbours can be told.
struct LatticeSums {
  double shepard = 1;    ///< sum of V W, the particle itself included
  double laplacian = 1;  ///< sum of -V F [1/m^2]
  double second_moment =
      1;  ///< sum of -V F x^2 for one axis: the factor by which 2 sum V F f_ij misses a Laplacian
  double face_gradient = 1;  ///< 2 |sum V F x| dx of the outermost layer of a flat face
  double face_fill = 1;      ///< Shepard sum of that layer over `shepard`
  double face_diagonal = 1;  ///< its Laplacian sum over `laplacian`
  double face_moment = 1;    ///< its second moment along the face over `second_moment`
  double layer_moment = 1;   ///< the part of that which comes from partners of the same layer
  int neighbours = 0;        ///< within the support, the particle itself not counted
};

LatticeSums lattice_sums(KernelType kernel, int dim, double spacing, double smoothing);

}  // namespace meltray::sph
