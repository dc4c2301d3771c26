// SPDX-License-Identifier: MIT
#include "meltray/sph/lattice.hpp"

#include <cmath>

#include "meltray/sph/pairs.hpp"

namespace meltray::sph {

namespace {

/// Sum of V W over one layer of the lattice, from a point over one of its sites.
double layer_sum(KernelType kernel, int dim, double spacing, double smoothing, double height) {
  const int reach = static_cast<int>(std::ceil(2 * smoothing / spacing));
  const double volume = std::pow(spacing, dim), inv_h = 1 / smoothing;
  double sum = 0;
  with_dim(dim, [&](auto d) {
    with_kernel<d>(kernel, [&](auto k) {
      using Kernel = decltype(k);
      for (int a = -reach; a <= reach; ++a)
        for (int b = dim == 3 ? -reach : 0; b <= (dim == 3 ? reach : 0); ++b)
          sum += volume * Kernel::w(std::hypot(height, a * spacing, b * spacing), inv_h);
    });
  });
  return sum;
}

}  // namespace

FaceDistance::FaceDistance(KernelType kernel, int dim, double spacing, double smoothing) {
  const int reach = static_cast<int>(std::ceil(2 * smoothing / spacing));
  double full = 0;
  for (int layer = -reach; layer <= reach; ++layer)
    full += layer_sum(kernel, dim, spacing, smoothing, layer * spacing);
  // Colour at a height over the face, by bisection: it falls with the height.
  const auto colour = [&](double height) {
    double sum = 0;
    for (int layer = 0; layer <= reach; ++layer)
      sum += layer_sum(kernel, dim, spacing, smoothing, height + (layer + 0.5) * spacing);
    return sum / full;
  };
  for (int k = 0; k < kPoints; ++k) {
    const double at = 0.5 * std::pow(k / (kPoints - 1.0), 2);
    double low = 0, high = 2 * smoothing - 0.5 * spacing;
    for (int halving = 0; halving < 40; ++halving) {
      const double middle = 0.5 * (low + high);
      (colour(middle) > at ? low : high) = middle;
    }
    distance_[k] = 0.5 * (low + high);
  }
}

LatticeSums lattice_sums(KernelType kernel, int dim, double spacing, double smoothing) {
  LatticeSums sums{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, FaceDistance(kernel, dim, spacing, smoothing)};
  const int reach = static_cast<int>(std::ceil(2 * smoothing / spacing));
  const double volume = std::pow(spacing, dim), inv_h = 1 / smoothing;
  double face = 0;
  with_dim(dim, [&](auto d) {
    with_kernel<d>(kernel, [&](auto k) {
      using Kernel = decltype(k);
      for (int a = -reach; a <= reach; ++a)
        for (int b = -reach; b <= reach; ++b)
          for (int c = dim == 3 ? -reach : 0; c <= (dim == 3 ? reach : 0); ++c) {
            const double x = a * spacing, r = spacing * std::sqrt(double(a * a + b * b + c * c));
            const double w = volume * Kernel::w(r, inv_h);
            sums.shepard += w;
            if (a <= 0) sums.face_fill += w;
            if (a == 0) sums.layer_spread += w * r * r;
            if (r == 0) continue;
            sums.neighbours += w > 0;
            const double f = volume * Kernel::f(r, inv_h);
            sums.laplacian -= f;
            sums.second_moment -= f * x * x;
            if (a > 0) continue;
            face += f * x;
            sums.face_diagonal -= f;
            const double along = f * std::pow(b * spacing, 2);
            sums.face_moment -= along;
            if (a == 0) sums.layer_moment -= along;
          }
    });
  });
  sums.face_gradient = 2 * std::abs(face) * spacing;
  sums.face_fill /= sums.shepard;
  sums.face_diagonal /= sums.laplacian;
  sums.face_moment /= sums.second_moment;
  sums.layer_moment /= sums.second_moment;
  return sums;
}

}  // namespace meltray::sph
