// SPDX-License-Identifier: MIT
#include <cmath>

#include "meltray/sph/renormalise.hpp"
#include "meltray/terms/surface_forces.hpp"

namespace meltray::terms {

void Marangoni::add_acceleration(const Stage& s, const MutField& acceleration) const {
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    using Matrix = Eigen::Matrix<double, D, D>;
    using Vector = Eigen::Matrix<double, D, 1>;
    const double rho = s.constants->density;
    parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t k) {
      const Index i = s.moving[k];
      if (s.surface[i] == 0 || s.loose[i]) return;
      const double slope = s.constants->material.sigma_slope(s.temperature[i]);
      if (slope == 0) return;
      Matrix moment = Matrix::Zero();
      Vector gradient = Vector::Zero();
      s.pairs->for_row<D>(i, [&](const sph::Pair<D>& p) {
        // An adiabatic wall's dummies have no temperature of their own.
        const int wall = s.patch->wall[p.j];
        if (wall && !s.constants->faces[wall - 1].isothermal) return;
        const double vf = s.volume[p.j] * p.f;
        for (int a = 0; a < D; ++a) gradient[a] += vf * (s.temperature[p.j] - s.temperature[i]) * p.x[a];
        sph::add_moment<D>(moment, vf, p);
      });
      gradient = sph::renormalisation<D>(moment) * gradient;
      Vector n;
      double c2 = 0;
      for (int c = 0; c < D; ++c) {
        n[c] = s.normal[c][i];
        c2 += s.grad_c[c][i] * s.grad_c[c][i];
      }
      gradient -= n * n.dot(gradient);
      const double factor = slope * 2 * std::sqrt(c2) / (rho * s.constants->lattice.face_gradient);
      for (int c = 0; c < D; ++c) acceleration[c][i] += factor * gradient[c];
    });
  });
}

}  // namespace meltray::terms
