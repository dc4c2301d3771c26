// SPDX-License-Identifier: MIT
#include "meltray/terms/viscosity.hpp"

#include <cmath>

namespace meltray::terms {

namespace {

/// Interface viscosity coefficient of one particle, Meier et al. 2021: free-surface part plus a part that
/// fades out linearly above the melting point. Solid neighbours carry the full solid part.
double alpha_of(const Stage& s, Index i, const InterfaceViscosityParameters& p, double grad_norm) {
  const double excess = s.temperature[i] - s.constants->melting_temperature();
  const double ramp = s.patch->liquid[i] ? std::clamp(1 - excess / p.ramp, 0.0, 1.0) : 1.0;
  return grad_norm * s.patch->smoothing[i] * p.free * (s.surface[i] > 0) + ramp * p.solid;
}

/// Factor on v_i - v_wall that makes the velocity profile vanish at the wall plane (Morris et al. 1997); the
/// distance of the particle is kept above half a spacing.
template <int D>
double no_slip_factor(const Stage& s, Index i, Index j) {
  const WallFace& face = s.constants->faces[s.patch->wall[j] - 1];
  const double di = std::max(std::abs(s.patch->x[face.axis][i] - face.plane), 0.5 * s.constants->spacing);
  return 1 + std::abs(s.patch->x[face.axis][j] - face.plane) / di;
}

}  // namespace

void ViscousOperator::assemble(const Stage& s, ViscousChoice choice, const InterfaceViscosityParameters& interface) {
  choice_ = choice;
  const auto& pairs = *s.pairs;
  const Index n = s.size();
  const double rho = s.constants->density, h = s.constants->smoothing;
  if (choice.physical) {
    mu_.resize(n);
    c_.resize(pairs.pairs());
    parallel_for(n, [&](Index i) { mu_[i] = s.constants->material.viscosity(s.temperature[i]); });
  }
  if (choice.interface) {
    alpha_.resize(n);
    d_.resize(pairs.pairs());
    parallel_for(n, [&](Index i) {
      double g = 0;
      for (int c = 0; c < s.constants->dim; ++c) g += s.grad_c[c][i] * s.grad_c[c][i];
      alpha_[i] = alpha_of(s, i, interface, std::sqrt(g));
    });
  }
  const double scale = 1 / s.constants->lattice.second_moment;
  const bool no_slip = s.constants->any_no_slip;
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t k) {
      const Index i = s.moving[k];
      const double vi = s.volume[i];
      pairs.for_row<D>(i, [&](Index q, const sph::Pair<D>& p) {
        const double vv = vi * s.volume[p.j];
        if (choice_.physical) {
          // A solid or wall neighbour has the viscosity of the melt beside it.
          const double mu_j = s.patch->liquid[p.j] ? mu_[p.j] : mu_[i];
          double c = 2 * vv * scale * p.f * (2 * mu_[i] * mu_j / (mu_[i] + mu_j));
          if (s.patch->wall[p.j]) {
            const WallFace& face = s.constants->faces[s.patch->wall[p.j] - 1];
            c *= face.no_slip ? (no_slip ? no_slip_factor<D>(s, i, p.j) : 1.0) : 0.0;
          }
          c_[q] = c;
        }
        if (choice_.interface)
          d_[q] = 0.5 * (alpha_[i] + alpha_[p.j]) * vv * rho * h * interface.reference_speed * p.f /
                  (p.r2() + 0.01 * h * h);
      });
    });
  });
}

void ViscousOperator::add_acceleration(const Stage& s, const ConstField& v, const MutField& acceleration) const {
  const auto& pairs = *s.pairs;
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t k) {
      const Index i = s.moving[k];
      double f[D] = {}, vi[D];
      for (int c = 0; c < D; ++c) vi[c] = v[c][i];
      pairs.for_row<D>(i, [&](Index q, const sph::Pair<D>& p) {
        double dv[D], dot = 0;
        for (int c = 0; c < D; ++c) {
          dv[c] = vi[c] - v[c][p.j];
          dot += dv[c] * p.x[c];
        }
        const double cc = choice_.physical ? c_[q] : 0, dd = choice_.interface ? d_[q] * dot : 0;
        for (int c = 0; c < D; ++c) f[c] += cc * dv[c] + dd * p.x[c];
      });
      for (int c = 0; c < D; ++c) acceleration[c][i] += f[c] / s.patch->mass[i];
    });
  });
}

double ViscousOperator::rate(const Stage& s) const {
  const auto& pairs = *s.pairs;
  return sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    return parallel_max(static_cast<std::ptrdiff_t>(s.moving.size()), 0.0, [&](std::ptrdiff_t k) {
      const Index i = s.moving[k];
      double sum = 0;
      pairs.for_row<D>(i, [&](Index q, const sph::Pair<D>& p) {
        if (choice_.physical) sum -= c_[q];
        // The projected part acts on one of D directions; its trace bounds the row.
        if (choice_.interface) sum -= d_[q] * p.r2();
      });
      return sum / s.patch->mass[i];
    });
  });
}

int ViscousOperator::solve(const Stage& s, double gamma, const ConstField& b, const MutField& x, double tolerance,
                           int max_iterations) const {
  // (M - gamma K) x = M b on moving particles, K x_i = sum_j c_ij x_ij + d_ij (x_ij.e) e with resting neighbours
  // held at zero change; symmetric positive definite: conjugate gradients with a diagonal preconditioner.
  const Index n = s.size();
  const auto& pairs = *s.pairs;
  const auto count = static_cast<std::ptrdiff_t>(s.moving.size());
  for (int c = 0; c < s.constants->dim; ++c) {
    r_[c].resize(n);
    ap_[c].resize(n);
    p_[c].assign(n, 0.0);
  }
  inverse_diagonal_.resize(n);
  return sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    const double* const mass = s.patch->mass.data();
    const auto apply = [&](const Components& in, Components& out) {
      parallel_for(count, [&](std::ptrdiff_t k) {
        const Index i = s.moving[k];
        double f[D] = {};
        pairs.for_row<D>(i, [&](Index q, const sph::Pair<D>& p) {
          double dv[D], dot = 0;
          for (int c = 0; c < D; ++c) {
            dv[c] = in[c][i] - in[c][p.j];
            dot += dv[c] * p.x[c];
          }
          const double cc = choice_.physical ? c_[q] : 0, dd = choice_.interface ? d_[q] * dot : 0;
          for (int c = 0; c < D; ++c) f[c] += cc * dv[c] + dd * p.x[c];
        });
        for (int c = 0; c < D; ++c) out[c][i] = mass[i] * in[c][i] - gamma * f[c];
      });
    };
    const auto dot = [&](const Components& a, const Components& bb, const double* weight) {
      return parallel_sum(count, [&](std::ptrdiff_t k) {
        const Index i = s.moving[k];
        double sum = 0;
        for (int c = 0; c < D; ++c) sum += a[c][i] * bb[c][i];
        return weight ? sum * weight[i] : sum;
      });
    };
    parallel_for(count, [&](std::ptrdiff_t k) {
      const Index i = s.moving[k];
      double diagonal = 0;
      pairs.for_row<D>(i, [&](Index q, const sph::Pair<D>& p) {
        if (choice_.physical) diagonal -= c_[q];
        if (choice_.interface) diagonal -= d_[q] * p.r2() / D;
      });
      inverse_diagonal_[i] = 1 / (mass[i] + gamma * diagonal);
      for (int c = 0; c < D; ++c) p_[c][i] = x[c][i];
    });
    apply(p_, ap_);
    const double target = tolerance * tolerance * parallel_sum(count, [&](std::ptrdiff_t k) {
                            const Index i = s.moving[k];
                            double sum = 0;
                            for (int c = 0; c < D; ++c) sum += b[c][i] * b[c][i];
                            return sum * mass[i] * mass[i] * inverse_diagonal_[i];
                          });
    parallel_for(count, [&](std::ptrdiff_t k) {
      const Index i = s.moving[k];
      for (int c = 0; c < D; ++c) {
        r_[c][i] = mass[i] * b[c][i] - ap_[c][i];
        p_[c][i] = inverse_diagonal_[i] * r_[c][i];
      }
    });
    double rz = dot(r_, r_, inverse_diagonal_.data());
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      if (rz <= target) return iteration;
      apply(p_, ap_);
      const double alpha = rz / dot(p_, ap_, nullptr);
      parallel_for(count, [&](std::ptrdiff_t k) {
        const Index i = s.moving[k];
        for (int c = 0; c < D; ++c) {
          x[c][i] += alpha * p_[c][i];
          r_[c][i] -= alpha * ap_[c][i];
        }
      });
      const double next = dot(r_, r_, inverse_diagonal_.data());
      const double beta = next / rz;
      rz = next;
      parallel_for(count, [&](std::ptrdiff_t k) {
        const Index i = s.moving[k];
        for (int c = 0; c < D; ++c) p_[c][i] = inverse_diagonal_[i] * r_[c][i] + beta * p_[c][i];
      });
    }
    return rz <= target ? max_iterations : -1;
  });
}

}  // namespace meltray::terms
