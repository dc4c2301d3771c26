// SPDX-License-Identifier: MIT
#include "meltray/sph/renormalise.hpp"
#include "meltray/terms/surface_forces.hpp"

namespace meltray::terms {

namespace {

/// Normal of the surface near particle i: that of its surface neighbours and its own, averaged. Zero far from
/// the surface.
template <int D>
Eigen::Matrix<double, D, 1> mean_normal(const Stage& s, Index i) {
  using Vector = Eigen::Matrix<double, D, 1>;
  const auto sum = s.pairs->sum_row<D, D>(i, [&](const sph::PairLanes<D>& p) {
    const sph::Lanes weight = p.of(s.surface.data()) * p.of(s.patch->liquid.data()) * p.w;
    std::array<sph::Lanes, D> out;
    for (int c = 0; c < D; ++c) out[c] = weight * p.of(s.normal[c].data());
    return out;
  });
  Vector n(sum.data());
  with_kernel<D>(s.constants->kernel, [&](auto kernel) {
    using Kernel = decltype(kernel);
    const double self = s.surface[i] * Kernel::w(0.0, 1 / s.patch->smoothing[i]);
    for (int c = 0; c < D; ++c) n[c] += self * s.normal[c][i];
  });
  const double norm = n.norm();
  return norm > 0 ? Vector(n / norm) : Vector(Vector::Zero());
}

}  // namespace

void Marangoni::add_acceleration(const Stage& s, const MutField& acceleration) const {
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    using Matrix = Eigen::Matrix<double, D, D>;
    using Vector = Eigen::Matrix<double, D, 1>;
    const double rho = s.constants->density;
    const double *const volume = s.volume.data(), *const temperature = s.temperature.data();
    parallel_for_uneven(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t k) {
      const Index i = s.moving[k];
      if (s.loose[i]) return;
      const double slope = s.constants->material.sigma_slope(s.temperature[i]);
      if (slope == 0) return;
      const Vector n = mean_normal<D>(s, i);
      double across = 0;  // -n.grad c
      for (int c = 0; c < D; ++c) across -= n[c] * s.grad_c[c][i];
      if (across == 0) return;
      const double ti = s.temperature[i];
      const auto sum = s.pairs->sum_row<D, D + symmetric_count(D)>(i, [&](const sph::PairLanes<D>& p) {
        const sph::Lanes vf = p.of(volume) * p.f, dt = p.of(temperature) - ti;
        std::array<sph::Lanes, D + symmetric_count(D)> out;
        for (int c = 0; c < D; ++c) out[c] = vf * dt * p.x[c];
        sph::moments<D>(vf, p, out.data() + D);
        return out;
      });
      Vector gradient(sum.data());
      Matrix moment = sph::symmetric<D>(sum.data() + D);
      if (s.pairs->next_to_wall()[i])
        s.pairs->for_row<D>(i, [&](const sph::Pair<D>& p) {
          // An adiabatic wall's dummies have no temperature of their own.
          const int wall = s.patch->wall[p.j];
          if (!wall || s.constants->faces[wall - 1].isothermal) return;
          const Vector x(p.x.data());
          const double vf = volume[p.j] * p.f;
          gradient -= vf * (temperature[p.j] - ti) * x;
          moment += vf * x * x.transpose();
        });
      gradient = sph::renormalisation<D>(moment) * gradient;
      gradient -= n * n.dot(gradient);
      const double factor = slope * 2 * across / (rho * s.constants->lattice.second_moment);
      for (int c = 0; c < D; ++c) acceleration[c][i] += factor * gradient[c];
    });
  });
}

}  // namespace meltray::terms
