// SPDX-License-Identifier: MIT
#include "meltray/terms/shifting.hpp"

#include <cmath>

namespace meltray::terms {

namespace {

/// Largest shifting velocity over the particle's own speed.
constexpr double kLargest = 0.2;

}  // namespace

void Shifting::add_rates(const Stage& s, const MutField& transport, const MutField& acceleration) const {
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    with_kernel<D>(s.constants->kernel, [&](auto kernel) {
      using Kernel = decltype(kernel);
      const ConstField v = view(static_cast<const Patch*>(s.patch)->v);
      const double* const volume = s.volume.data();
      const double second_moment = s.constants->lattice.second_moment;
      const double inverse_w = 1 / Kernel::w(s.constants->spacing, 1 / s.constants->smoothing);
      parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t k) {
        const Index i = s.moving[k];
        const double inside = 1 - s.surface[i];
        if (inside == 0 || s.loose[i]) return;
        const auto sum = s.pairs->template sum_row<D, D>(i, [&](const sph::PairLanes<D>& p) {
          const sph::Lanes ratio = p.w * inverse_w, r2 = ratio * ratio;
          const sph::Lanes push = 0.2 * max(r2 * r2 - 1, sph::Lanes(0));
          const sph::Lanes g = p.of(volume) * p.f * (1 + push);
          std::array<sph::Lanes, D> out;
          for (int c = 0; c < D; ++c) out[c] = g * p.x[c];
          return out;
        });
        double speed = 0, gradient = 0;
        for (int c = 0; c < D; ++c) {
          speed += v[c][i] * v[c][i];
          gradient += sum[c] * sum[c];
        }
        // C h |sum| / (1 + C h |sum| / kLargest): a particle is never shifted faster than a share of its
        // speed.
        const double strength = coefficient * s.constants->smoothing;
        const double scale = -strength * std::max(std::sqrt(speed), least_speed) * inside /
                             (1 + strength * std::sqrt(gradient) / kLargest);
        double du[D];
        for (int c = 0; c < D; ++c) {
          du[c] = scale * sum[c];
          transport[c][i] += du[c];
        }
        const auto gain = s.pairs->template sum_row<D, D>(i, [&](const sph::PairLanes<D>& p) {
          sph::Lanes along = 0;
          for (int c = 0; c < D; ++c) along += du[c] * p.x[c];
          const sph::Lanes g = p.of(volume) * p.f * along;
          std::array<sph::Lanes, D> out;
          for (int c = 0; c < D; ++c) out[c] = g * (p.of(v[c]) - v[c][i]);
          return out;
        });
        for (int c = 0; c < D; ++c) acceleration[c][i] += gain[c] / second_moment;
      });
    });
  });
}

}  // namespace meltray::terms
