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
double no_slip_factor(const Stage& s, Index i, Index j) {
  const WallFace& face = s.constants->faces[s.patch->wall[j] - 1];
  const double di = std::max(std::abs(s.patch->x[face.axis][i] - face.plane), 0.5 * s.constants->spacing);
  return 1 + std::abs(s.patch->x[face.axis][j] - face.plane) / di;
}

}  // namespace

void ViscousOperator::assemble(const Stage& s, ViscousChoice choice,
                               const InterfaceViscosityParameters& interface) {
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
  const double scale = 2 / s.constants->lattice.second_moment;
  const double strength = 0.5 * rho * h * interface.reference_speed, softening = 0.01 * h * h;
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    const double* const volume = s.volume.data();
    const double *const mu = mu_.data(), *const alpha = alpha_.data();
    const std::uint8_t* const liquid = s.patch->liquid.data();
    double *const c = c_.data(), *const dd = d_.data();
    parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t row) {
      const Index i = s.moving[row];
      const double vi = volume[i];
      if (choice_.physical) {
        const double mu_i = mu[i];
        // A solid or wall neighbour has the viscosity of the melt beside it.
        pairs.for_row_simd<D>(i, [&](const sph::Pair<D>& p) {
          const double mu_j = liquid[p.j] ? mu[p.j] : mu_i;
          c[p.k] = scale * vi * volume[p.j] * p.f * (2 * mu_i * mu_j / (mu_i + mu_j));
        });
        if (pairs.next_to_wall()[i])
          pairs.for_row<D>(i, [&](const sph::Pair<D>& p) {
            if (!s.patch->wall[p.j]) return;
            const WallFace& face = s.constants->faces[s.patch->wall[p.j] - 1];
            c[p.k] *= face.no_slip ? no_slip_factor(s, i, p.j) : 0.0;
          });
      }
      if (choice_.interface) {
        const double alpha_i = alpha[i], vs = vi * strength;
        pairs.for_row_simd<D>(i, [&](const sph::Pair<D>& p) {
          dd[p.k] = (alpha_i + alpha[p.j]) * vs * volume[p.j] * p.f / (p.r2() + softening);
        });
      }
    });
  });
}

/// sum_j c_ij u_ij + d_ij (u_ij.x_ij) x_ij of one row for a velocity-like field u.
template <int D, bool Physical, bool Interface>
std::array<double, D> ViscousOperator::row(const Stage& s, Index i, const ConstField& u) const {
  const double *const cc = c_.data(), *const dd = d_.data();
  double ui[D];
  for (int c = 0; c < D; ++c) ui[c] = u[c][i];
  return s.pairs->sum_row<D, D>(i, [&](const sph::Pair<D>& p) {
    double du[D], along = 0;
    for (int c = 0; c < D; ++c) {
      du[c] = ui[c] - u[c][p.j];
      along += du[c] * p.x[c];
    }
    const double iso = Physical ? cc[p.k] : 0.0, axial = Interface ? dd[p.k] * along : 0.0;
    std::array<double, D> out;
    for (int c = 0; c < D; ++c) out[c] = iso * du[c] + axial * p.x[c];
    return out;
  });
}

/// Calls f(i, row sum) for every moving particle, with the loop compiled for the active parts.
template <int D, class F>
void ViscousOperator::for_rows(const Stage& s, const ConstField& u, F&& f) const {
  const auto count = static_cast<std::ptrdiff_t>(s.moving.size());
  const auto run = [&](auto physical, auto interface) {
    parallel_for(count, [&](std::ptrdiff_t k) {
      const Index i = s.moving[k];
      f(i, row<D, physical, interface>(s, i, u));
    });
  };
  if (choice_.physical && choice_.interface)
    run(std::true_type{}, std::true_type{});
  else if (choice_.physical)
    run(std::true_type{}, std::false_type{});
  else
    run(std::false_type{}, std::true_type{});
}

void ViscousOperator::add_acceleration(const Stage& s, const ConstField& v,
                                       const MutField& acceleration) const {
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    for_rows<D>(s, v, [&](Index i, const std::array<double, D>& force) {
      for (int c = 0; c < D; ++c) acceleration[c][i] += force[c] / s.patch->mass[i];
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
      pairs.for_row<D>(i, [&](const sph::Pair<D>& p) {
        if (choice_.physical) sum -= c_[p.k];
        // The projected part acts on one of D directions; its trace bounds the row.
        if (choice_.interface) sum -= d_[p.k] * p.r2();
      });
      return sum / s.patch->mass[i];
    });
  });
}

int ViscousOperator::solve(const Stage& s, double gamma, const ConstField& b, const MutField& x,
                           double tolerance, int max_iterations) const {
  // (M - gamma K) x = M b on moving particles, K x_i = sum_j c_ij x_ij + d_ij (x_ij.e) e with resting
  // neighbours held at zero change; symmetric positive definite: conjugate gradients with a diagonal
  // preconditioner.
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
      for_rows<D>(s, view(in), [&](Index i, const std::array<double, D>& force) {
        for (int c = 0; c < D; ++c) out[c][i] = mass[i] * in[c][i] - gamma * force[c];
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
      pairs.for_row<D>(i, [&](const sph::Pair<D>& p) {
        if (choice_.physical) diagonal -= c_[p.k];
        if (choice_.interface) diagonal -= d_[p.k] * p.r2() / D;
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
