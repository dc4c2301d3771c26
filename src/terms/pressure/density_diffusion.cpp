// SPDX-License-Identifier: MIT
#include "meltray/sph/renormalise.hpp"
#include "meltray/terms/pressure/weakly_compressible.hpp"

namespace meltray::terms {

namespace {

/// Renormalised gradient of the excess density over the moving neighbours of one particle.
template <int D>
Eigen::Matrix<double, D, 1> excess_gradient(const Stage& s, Index i) {
  constexpr int kMoments = D * (D + 1) / 2;
  const double *const e = s.excess.data(), *const volume = s.volume.data();
  const std::uint8_t* const liquid = s.patch->liquid.data();
  const double ei = e[i];
  const auto sum = s.pairs->sum_row<D, D>(i, [&](const sph::Pair<D>& p) {
    const double g = liquid[p.j] ? volume[p.j] * p.f * (e[p.j] - ei) : 0.0;
    std::array<double, D> out;
    for (int c = 0; c < D; ++c) out[c] = g * p.x[c];
    return out;
  });
  const auto second = s.pairs->sum_row<D, kMoments>(i, [&](const sph::Pair<D>& p) {
    const double vf = liquid[p.j] ? -volume[p.j] * p.f : 0.0;
    std::array<double, kMoments> out;
    int n = 0;
    for (int a = 0; a < D; ++a)
      for (int b = a; b < D; ++b) out[n++] = vf * p.x[a] * p.x[b];
    return out;
  });
  Eigen::Matrix<double, D, D> moment;
  Eigen::Matrix<double, D, 1> gradient;
  int n = 0;
  for (int a = 0; a < D; ++a) {
    gradient[a] = sum[a];
    for (int b = a; b < D; ++b) moment(a, b) = moment(b, a) = second[n++];
  }
  return sph::renormalisation<D>(moment) * gradient;
}

}  // namespace

void DensityDiffusion::add_rate(const Stage& s, double* density_rate) const {
  const double strength =
      coefficient * s.constants->smoothing * sound_speed / s.constants->lattice.second_moment;
  const bool corrected = form == DiffusionForm::antuono;
  const auto count = static_cast<std::ptrdiff_t>(s.moving.size());
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    const double *const e = s.excess.data(), *const volume = s.volume.data();
    const std::uint8_t* const liquid = s.patch->liquid.data();
    for (int c = 0; c < D; ++c) gradient_[c].resize(s.size());
    if (corrected)
      parallel_for(count, [&](std::ptrdiff_t k) {
        const Index i = s.moving[k];
        const auto g = excess_gradient<D>(s, i);
        for (int c = 0; c < D; ++c) gradient_[c][i] = g[c];
      });
    const ConstField g = view(static_cast<const Components&>(gradient_));
    parallel_for(count, [&](std::ptrdiff_t k) {
      const Index i = s.moving[k];
      double gi[D];
      for (int c = 0; c < D; ++c) gi[c] = corrected ? g[c][i] : 0.0;
      const auto sum = s.pairs->sum_row<D, 1>(i, [&](const sph::Pair<D>& p) {
        double jump = 2 * (e[p.j] - e[i]);
        if (corrected)
          for (int c = 0; c < D; ++c) jump += (gi[c] + g[c][p.j]) * p.x[c];
        return std::array<double, 1>{liquid[p.j] ? -volume[p.j] * p.f * jump : 0.0};
      });
      density_rate[i] += strength * sum[0];
    });
  });
}

}  // namespace meltray::terms
