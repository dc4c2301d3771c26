// SPDX-License-Identifier: MIT
#include "meltray/terms/pressure/weakly_compressible.hpp"

namespace meltray::terms {

void Continuity::add_rate(const Stage& s, double* density_rate) const {
  const double scale = 1 / s.constants->lattice.second_moment;
  const ConstField v = view(static_cast<const Patch*>(s.patch)->v);
  const double* const volume = s.volume.data();
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t k) {
      const Index i = s.moving[k];
      double vi[D];
      for (int c = 0; c < D; ++c) vi[c] = v[c][i];
      const auto sum = s.pairs->sum_row<D, 1>(i, [&](const sph::Pair<D>& p) {
        double dot = 0;
        for (int c = 0; c < D; ++c) dot += (vi[c] - v[c][p.j]) * p.x[c];
        return std::array<double, 1>{volume[p.j] * p.f * dot};
      });
      density_rate[i] += scale * s.patch->density[i] * sum[0];
      if (s.loose[i]) density_rate[i] -= s.excess[i] * sound_speed / s.constants->smoothing;
    });
  });
}

}  // namespace meltray::terms
