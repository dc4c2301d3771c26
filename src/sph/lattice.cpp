// SPDX-License-Identifier: MIT
#include "meltray/sph/lattice.hpp"

#include <cmath>

#include "meltray/sph/pairs.hpp"

namespace meltray::sph {

LatticeSums lattice_sums(KernelType kernel, int dim, double spacing, double smoothing) {
  LatticeSums sums{0, 0, 0, 0, 0, 0, 0, 0, 0};
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
