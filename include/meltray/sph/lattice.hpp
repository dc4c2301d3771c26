// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "meltray/sph/kernel.hpp"

namespace meltray::sph {

/// How far outside a flat face of lattice material a point lies, told from the material's colour there: the
/// sum of V W over it, over that of a full lattice. The face lies half a spacing outside its outermost layer.
class FaceDistance {
 public:
  FaceDistance() = default;
  FaceDistance(KernelType kernel, int dim, double spacing, double smoothing);
  /// Distance [m] of a colour between 0 (out of reach) and 0.5 (on the face); nearer than that is 0.
  double operator()(double colour) const {
    const double place = std::sqrt(std::clamp(colour / 0.5, 0.0, 1.0)) * (kPoints - 1);
    const int k = std::min(static_cast<int>(place), kPoints - 2);
    return distance_[k] + (place - k) * (distance_[k + 1] - distance_[k]);
  }

 private:
  static constexpr int kPoints = 129;
  std::array<double, kPoints> distance_{};  ///< at colours whose roots are equally spaced
};

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
  double layer_spread = 1;   ///< sum of V W t^2 over a layer, t the distance in it [m^2]
  int neighbours = 0;        ///< within the support, the particle itself not counted
  FaceDistance face_distance;
};

LatticeSums lattice_sums(KernelType kernel, int dim, double spacing, double smoothing);

}  // namespace meltray::sph
