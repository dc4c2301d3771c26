// SPDX-License-Identifier: MIT
#include "meltray/terms/viscosity.hpp"

#include <cmath>

#include "meltray/core/memory.hpp"

namespace meltray::terms {

namespace {

/// Interface viscosity coefficient of one particle, Meier et al. 2021: free-surface part plus a part that
/// fades out linearly above the melting point. A dummy behind a face of the box has the full solid part.
double alpha_of(const Stage& s, Index i, const InterfaceViscosityParameters& p, double grad_norm) {
  const double excess = s.temperature[i] - s.constants->melting_temperature();
  const double ramp = s.patch->wall[i] ? 1.0 : std::clamp(1 - excess / p.ramp, 0.0, 1.0);
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
  c_sum_.assign(n, 0.0);
  e2_sum_.assign(n, 0.0);
  if (choice.physical) {
    mu_.resize(n);
    resize_anew(c_, pairs.pairs());
    parallel_for(n, [&](Index i) { mu_[i] = s.constants->material.viscosity(s.temperature[i]); });
  }
  if (choice.interface) {
    alpha_.resize(n);
    for (int c = 0; c < s.constants->dim; ++c) resize_anew(e_[c], pairs.pairs());
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
    const std::uint8_t *const liquid = s.patch->liquid.data(), *const wall = s.patch->wall.data();
    float* const c = c_.data();
    float* const e[3] = {e_[0].data(), e_[1].data(), e_[2].data()};
    parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t row) {
      const Index i = s.moving[row];
      const double vi = volume[i];
      if (choice_.physical) {
        const double mu_i = mu[i];
        // A solid or wall neighbour has the viscosity of the melt beside it.
        pairs.for_row_simd<D>(i, [&](const sph::Pair<D>& p) {
          const double mu_j = liquid[p.j] ? mu[p.j] : mu_i;
          c[p.k] = static_cast<float>(scale * (vi * volume[p.j]) * p.f * (2 * mu_i * mu_j / (mu_i + mu_j)));
        });
        if (pairs.next_to_wall()[i])
          pairs.for_row<D>(i, [&](const sph::Pair<D>& p) {
            if (!s.patch->wall[p.j]) return;
            const WallFace& face = s.constants->faces[s.patch->wall[p.j] - 1];
            c[p.k] *= static_cast<float>(face.no_slip ? no_slip_factor(s, i, p.j) : 0.0);
          });
        double sum = 0;
        for (Index k = pairs.begin(i); k < pairs.end(i); ++k) sum -= c[k];
        c_sum_[i] = sum;
      }
      if (choice_.interface) {
        const double alpha_i = alpha[i];
        // A solid neighbour adds none of its own, as in the published form: melt hotter than the ramp slides
        // along it with the physical viscosity. A face of the box damps the melt that fills the box.
        pairs.for_row_simd<D>(i, [&](const sph::Pair<D>& p) {
          const double alpha_j = liquid[p.j] || wall[p.j] ? alpha[p.j] : alpha_i;
          const double d_ij =
              strength * (alpha_i + alpha_j) * (vi * volume[p.j]) * p.f / (p.r2() + softening);
          const double root = std::sqrt(-d_ij);
          for (int k = 0; k < D; ++k) e[k][p.k] = static_cast<float>(root * p.x[k]);
        });
        double sum = 0;
        for (int axis = 0; axis < D; ++axis)
          for (Index k = pairs.begin(i); k < pairs.end(i); ++k)
            sum += static_cast<double>(e[axis][k]) * e[axis][k];
        e2_sum_[i] = sum;
      }
    });
  });
}

/// sum_j c_ij u_ij - (u_ij.e_ij) e_ij of one row for a velocity-like field u.
template <int D, bool Physical, bool Interface>
std::array<double, D> ViscousOperator::row(const Stage& s, Index i,
                                           const std::array<const double*, D>& u) const {
  const float* const cc = c_.data();
  const float* const e[3] = {e_[0].data(), e_[1].data(), e_[2].data()};
  const Index* const neighbour = s.pairs->neighbours();
  double ui[D];
  for (int c = 0; c < D; ++c) ui[c] = u[c][i];
  double s0 = 0, s1 = 0, s2 = 0;
  const Index last = s.pairs->end(i);
#pragma omp simd reduction(+ : s0, s1, s2)
  for (Index k = s.pairs->begin(i); k < last; ++k) {
    const Index j = neighbour[k];
    double du[3], ek[3], along = 0;
    for (int c = 0; c < D; ++c) {
      du[c] = ui[c] - u[c][j];
      if constexpr (Interface) {
        ek[c] = e[c][k];
        along += du[c] * ek[c];
      }
    }
    const auto part = [&](int c) {
      double f = 0;
      if constexpr (Physical) f += cc[k] * du[c];
      if constexpr (Interface) f -= along * ek[c];
      return f;
    };
    s0 += part(0);
    s1 += part(1);
    if constexpr (D == 3) s2 += part(2);
  }
  if constexpr (D == 3)
    return {s0, s1, s2};
  else
    return {s0, s1};
}

/// Calls f(row) with row(s, i, u) compiled for the active parts.
template <int D, class F>
void ViscousOperator::with_row(F&& f) const {
  const auto compiled = [&](auto physical, auto interface) {
    f([&](const Stage& s, Index i, const std::array<const double*, D>& u) {
      return row<D, physical, interface>(s, i, u);
    });
  };
  if (choice_.physical && choice_.interface)
    compiled(std::true_type{}, std::true_type{});
  else if (choice_.physical)
    compiled(std::true_type{}, std::false_type{});
  else
    compiled(std::false_type{}, std::true_type{});
}

void ViscousOperator::add_acceleration(const Stage& s, const ConstField& v,
                                       const MutField& acceleration) const {
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    std::array<const double*, D> in;
    for (int c = 0; c < D; ++c) in[c] = v[c];
    with_row<D>([&](auto&& row_of) {
      parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t k) {
        const Index i = s.moving[k];
        const std::array<double, D> force = row_of(s, i, in);
        for (int c = 0; c < D; ++c) acceleration[c][i] += force[c] / s.patch->mass[i];
      });
    });
  });
}

double ViscousOperator::rate(const Stage& s, ViscousChoice part) const {
  // The interface part acts on one of D directions; its trace bounds the row.
  const double physical = part.physical, interface = part.interface;
  return parallel_max(static_cast<std::ptrdiff_t>(s.moving.size()), 0.0, [&](std::ptrdiff_t k) {
    const Index i = s.moving[k];
    return (physical * c_sum_[i] + interface * e2_sum_[i]) / s.patch->mass[i];
  });
}

ViscousSolve ViscousOperator::solve(const Stage& s, double gamma, const ConstField& b, const MutField& x,
                                    double tolerance, int max_iterations) const {
  return s.constants->dim == 2 ? solve_in<2>(s, gamma, b, x, tolerance, max_iterations, vectors_2d_)
                               : solve_in<3>(s, gamma, b, x, tolerance, max_iterations, vectors_3d_);
}

/// (M - gamma K) x = M b on moving particles, K x_i = sum_j c_ij x_ij - (x_ij.e_ij) e_ij; symmetric positive
/// definite.
template <int D>
ViscousSolve ViscousOperator::solve_in(const Stage& s, double gamma, const ConstField& b, const MutField& x,
                                       double tolerance, int max_iterations,
                                       solve::CgVectors<D>& vectors) const {
  const auto count = static_cast<std::ptrdiff_t>(s.moving.size());
  const double* const mass = s.patch->mass.data();
  vectors.resize(s.size());
  std::array<double*, D> out;
  for (int c = 0; c < D; ++c) out[c] = x[c];
  parallel_for(count, [&](std::ptrdiff_t k) {
    const Index i = s.moving[k];
    vectors.inverse_diagonal[i] = 1 / (mass[i] + gamma * (c_sum_[i] + e2_sum_[i] / D));
    for (int c = 0; c < D; ++c) vectors.r[c][i] = mass[i] * b[c][i];
  });
  solve::SolveReport report;
  with_row<D>([&](auto&& row_of) {
    report = solve::conjugate_gradient<D>(
        count, [&](std::ptrdiff_t k) { return s.moving[k]; },
        [&](Index i, const std::array<const double*, D>& in) {
          std::array<double, D> a = row_of(s, i, in);
          for (int c = 0; c < D; ++c) a[c] = mass[i] * in[c][i] - gamma * a[c];
          return a;
        },
        vectors, out, tolerance, max_iterations, solve::Relative::to_start);
  });
  // The last velocities take the viscous force of those before them, b + gamma M^-1 K x = x + M^-1 r: between
  // moving particles momentum is then conserved to round-off, however loose the tolerance.
  ViscousSolve result{report.iterations, report.converged};
  for (int c = 0; c < D; ++c)
    result.impulse[c] = parallel_sum_rows(count, [&](std::ptrdiff_t k) {
      const Index i = s.moving[k];
      x[c][i] += vectors.r[c][i] / mass[i];
      return mass[i] * (x[c][i] - b[c][i]);
    });
  return result;
}

}  // namespace meltray::terms
