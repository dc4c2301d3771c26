// SPDX-License-Identifier: MIT
#include <cmath>

#include "meltray/terms/pressure/weakly_compressible.hpp"

namespace meltray::terms {

namespace {

/// Monaghan 2000: repulsion as a share of a negative pressure, and of the sum of two positive ones.
constexpr double kUnderTension = 0.2, kUnderPressure = 0.01;

}  // namespace

void PressureForce::add_acceleration(const Stage& s, const MutField& acceleration) const {
  const double scale = 1 / s.constants->lattice.second_moment;
  const double *const p = s.patch->pressure.data(), *const volume = s.volume.data();
  const double own = form == GradientForm::sum ? 1 : -1;
  const double under_pressure = form == GradientForm::sum ? kUnderPressure : 0.0;
  const bool stressed = tension == Tension::artificial_stress;
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    with_kernel<D>(s.constants->kernel, [&](auto kernel) {
      using Kernel = decltype(kernel);
      const double inverse_w = 1 / Kernel::w(s.constants->spacing, 1 / s.constants->smoothing);
      parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t k) {
        const Index i = s.moving[k];
        const double pi = p[i];
        const auto sum = s.pairs->template sum_row<D, D>(i, [&](const sph::Pair<D>& q) {
          const double pj = p[q.j];
          double pair = own * pi + pj;
          if (stressed) {
            const double f = q.w * inverse_w, f2 = f * f;
            const double pull = std::min(pi, 0.0) + std::min(pj, 0.0);
            pair += f2 * f2 * (pull < 0 ? -kUnderTension * pull : under_pressure * (pi + pj));
          }
          const double g = volume[q.j] * q.f * pair;
          std::array<double, D> out;
          for (int c = 0; c < D; ++c) out[c] = g * q.x[c];
          return out;
        });
        const double factor = scale * volume[i] / s.patch->mass[i];
        for (int c = 0; c < D; ++c) acceleration[c][i] -= factor * sum[c];
      });
    });
  });
}

void PressureForce::add_surface_force(const Stage& s, const MutField& acceleration) const {
  const double scale = 2 / s.constants->lattice.second_moment;
  parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t k) {
    const Index i = s.moving[k];
    const double jump = form == GradientForm::sum
                            ? s.surface_pressure[i]
                            : s.surface[i] * (s.surface_pressure[i] - s.patch->pressure[i]);
    const double factor = scale * jump * s.volume[i] / s.patch->mass[i];
    for (int c = 0; c < s.constants->dim; ++c) acceleration[c][i] += factor * s.grad_c[c][i];
  });
}

}  // namespace meltray::terms
