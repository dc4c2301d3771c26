// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "meltray/core/constants.hpp"
#include "meltray/sph/renormalise.hpp"
#include "meltray/terms/surface_forces.hpp"

namespace meltray::terms {

double Recoil::pressure(const Material& m, double temperature, double t, double r2) const {
  if (prescribed > 0) {
    const double started = prescribed_ramp > 0 ? std::min(1.0, t / prescribed_ramp) : 1.0;
    const double share =
        prescribed_radius > 0 ? std::exp(-2 * r2 / (prescribed_radius * prescribed_radius)) : 1.0;
    return prescribed * started * share;
  }
  const double p = coefficient * m.saturation_pressure(temperature);
  switch (onset) {
    case RecoilOnset::smooth:
      return p;
    case RecoilOnset::cutoff:
      return temperature >= m.boiling_temperature ? p : 0.0;
    case RecoilOnset::ambient:
      return std::max(0.0, p - constants::standard_atmosphere);
  }
  return p;
}

void add_recoil_along_surface(const Stage& s, const std::vector<double>& recoil,
                              const MutField& acceleration) {
  const double missing = 1 - s.constants->lattice.face_moment, rho = s.constants->density;
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    using Vector = Eigen::Matrix<double, D, 1>;
    using Matrix = Eigen::Matrix<double, D, D>;
    const double *const q = recoil.data(), *const volume = s.volume.data(), *const surface = s.surface.data();
    const std::uint8_t* const melt = s.patch->liquid.data();
    parallel_for_uneven(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t k) {
      const Index i = s.moving[k];
      const double share = surface[i] * s.exposure[i];
      if (share == 0 || s.loose[i]) return;
      const auto sum = s.pairs->sum_row<D, D + symmetric_count(D)>(i, [&](const sph::PairLanes<D>& p) {
        const sph::Lanes vf = p.of(volume) * p.f * p.of(surface) * p.of(melt), dq = p.of(q) - q[i];
        std::array<sph::Lanes, D + symmetric_count(D)> out;
        for (int c = 0; c < D; ++c) out[c] = vf * dq * p.x[c];
        sph::moments<D>(vf, p, out.data() + D);
        return out;
      });
      Vector n;
      for (int c = 0; c < D; ++c) n[c] = s.grad_c[c][i];
      n.normalize();
      // Within the plane of the surface; across it the matrix is one, so that it can be inverted.
      const Matrix across = n * n.transpose(), along = Matrix::Identity() - across;
      const Matrix moment = along * sph::symmetric<D>(sum.data() + D) * along + across;
      const Vector gradient = along * (sph::renormalisation<D>(moment) * (along * Vector(sum.data())));
      for (int c = 0; c < D; ++c) acceleration[c][i] -= missing * share * gradient[c] / rho;
    });
  });
}

}  // namespace meltray::terms
