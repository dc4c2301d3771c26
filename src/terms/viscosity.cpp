// SPDX-License-Identifier: MIT
#include "meltray/terms/viscosity.hpp"

#include <cmath>

#include "meltray/core/memory.hpp"
#include "terms/solid_beside.hpp"

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

/// Lets the velocity vanish at the face of the solid beside melt particle i, not at the centres of its
/// outermost particles half a spacing behind: the profile continues into the solid as behind a wall. Where
/// the face lies is told by the solid's colour and its gradient, as for a flat one.
template <int D>
void extend_into_solid(const Stage& s, Index i, float* c) {
  const std::uint8_t *const liquid = s.patch->liquid.data(), *const wall = s.patch->wall.data();
  const double* const volume = s.volume.data();
  const SolidBeside<D> solid = solid_beside<D>(s, i, [&](const sph::PairLanes<D>& p) {
    sph::Lanes v = p.of(volume);
    where(p.of(liquid) + p.of(wall) > 0, v) = 0;
    return v;
  });
  if (solid.colour <= 0) return;
  const double height =
      std::max(s.constants->lattice.face_distance(solid.colour), 0.5 * s.constants->spacing);
  s.pairs->for_row<D>(i, [&](const sph::Pair<D>& p) {
    if (liquid[p.j] || wall[p.j]) return;
    double down = 0;  // from i to j, into the solid
    for (int k = 0; k < D; ++k) down -= p.x[k] * solid.into[k];
    c[p.k] *= static_cast<float>(std::max(down / height, 1.0));
  });
}

}  // namespace

void ViscousOperator::assemble(const Stage& s, ViscousChoice choice,
                               const InterfaceViscosityParameters& interface) {
  choice_ = choice;
  const auto& pairs = *s.pairs;
  const Index n = s.size();
  const double rho = s.constants->density, h = s.constants->smoothing;
  c_sum_.assign(n, 0.0);
  d_sum_.assign(n, 0.0);
  if (choice.physical) {
    mu_.resize(n);
    resize_anew(c_, pairs.slots());
    parallel_for(n, [&](Index i) {
      mu_[i] = s.patch->liquid[i] ? s.constants->material.viscosity(s.temperature[i]) : -1.0;
    });
  }
  if (choice.interface) {
    alpha_.resize(n);
    resize_anew(d_, pairs.slots());
    parallel_for(n, [&](Index i) {
      double g = 0;
      for (int c = 0; c < s.constants->dim; ++c) g += s.grad_c[c][i] * s.grad_c[c][i];
      const bool own = s.patch->liquid[i] || s.patch->wall[i];
      alpha_[i] = own ? alpha_of(s, i, interface, std::sqrt(g)) : -1.0;
    });
  }
  const double scale = 2 / s.constants->lattice.second_moment;
  const double strength = 0.5 * rho * h * interface.reference_speed, softening = 0.01 * h * h;
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    const double* const volume = s.volume.data();
    const double *const mu = mu_.data(), *const alpha = alpha_.data();
    float* const c = c_.data();
    float* const d_of = d_.data();
    parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t row) {
      const Index i = s.moving[row];
      const double vi = volume[i];
      if (choice_.physical) {
        const double mu_i = mu[i];
        // A solid or wall neighbour has the viscosity of the melt beside it.
        bool at_solid = false;
        pairs.for_lanes<D>(i, [&](const sph::PairLanes<D>& p) {
          sph::Lanes mu_j = p.of(mu);
          at_solid |= any_of(mu_j < 0);
          where(mu_j < 0, mu_j) = mu_i;
          sph::store(c + p.k, scale * (vi * p.of(volume)) * p.f * (2 * mu_i * mu_j / (mu_i + mu_j)));
        });
        if (pairs.next_to_wall()[i])
          pairs.for_row<D>(i, [&](const sph::Pair<D>& p) {
            if (!s.patch->wall[p.j]) return;
            const WallFace& face = s.constants->faces[s.patch->wall[p.j] - 1];
            c[p.k] *= static_cast<float>(face.no_slip ? no_slip_factor(s, i, p.j) : 0.0);
          });
        if (at_solid) extend_into_solid<D>(s, i, c);
        sph::Lanes sum = 0;
        for (Index k = pairs.begin(i); k < pairs.filled_end(i); k += sph::kLaneCount) sum -= sph::load(c + k);
        c_sum_[i] = sph::sum(sum);
      }
      if (choice_.interface) {
        const double alpha_i = alpha[i];
        // A solid neighbour adds none of its own, as in the published form: melt hotter than the ramp slides
        // along it with the physical viscosity. A face of the box damps the melt that fills the box.
        sph::Lanes sum = 0;
        pairs.for_lanes<D>(i, [&](const sph::PairLanes<D>& p) {
          sph::Lanes alpha_j = p.of(alpha);
          where(alpha_j < 0, alpha_j) = alpha_i;
          const sph::Lanes d_ij =
              strength * (alpha_i + alpha_j) * (vi * p.of(volume)) * p.f / (p.r2() + softening);
          sph::store(d_of + p.k, d_ij);
          sum -= sph::load(d_of + p.k) * p.r2();
        });
        d_sum_[i] = sph::sum(sum);
        if (pairs.next_to_wall()[i])  // slip faces do not drag
          pairs.for_row<D>(i, [&](const sph::Pair<D>& p) {
            if (!s.patch->wall[p.j] || s.constants->faces[s.patch->wall[p.j] - 1].no_slip) return;
            d_sum_[i] += d_of[p.k] * p.r2();
            d_of[p.k] = 0;
          });
      }
    });
  });
}

/// sum_j c_ij u_ij + d_ij (u_ij.x_ij) x_ij of one row for a velocity-like field u.
template <int D, bool Physical, bool Interface>
std::array<double, D> ViscousOperator::row(const Stage& s, Index i,
                                           const std::array<const double*, D>& u) const {
  const float *const physical = c_.data(), *const interface = d_.data();
  std::array<double, D> ui;
  for (int c = 0; c < D; ++c) ui[c] = u[c][i];
  return s.pairs->sum_row<D, D>(i, [&](const sph::PairLanes<D>& p) {
    std::array<sph::Lanes, D> du, force;
    for (int c = 0; c < D; ++c) du[c] = ui[c] - p.of(u[c]);
    force.fill(sph::Lanes(0));
    if constexpr (Interface) {
      sph::Lanes along = du[0] * p.x[0];
      for (int c = 1; c < D; ++c) along += du[c] * p.x[c];
      along *= sph::load(interface + p.k);
      for (int c = 0; c < D; ++c) force[c] = along * p.x[c];
    }
    if constexpr (Physical) {
      const sph::Lanes c_ij = sph::load(physical + p.k);
      for (int c = 0; c < D; ++c) force[c] += c_ij * du[c];
    }
    return force;
  });
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
    return (physical * c_sum_[i] + interface * d_sum_[i]) / s.patch->mass[i];
  });
}

ViscousSolve ViscousOperator::solve(const Stage& s, double gamma, const ConstField& b, const MutField& x,
                                    double tolerance, int max_iterations) const {
  return s.constants->dim == 2 ? solve_in<2>(s, gamma, b, x, tolerance, max_iterations, vectors_2d_)
                               : solve_in<3>(s, gamma, b, x, tolerance, max_iterations, vectors_3d_);
}

/// (M - gamma K) x = M b on moving particles, K x_i = sum_j c_ij u_ij + d_ij (u_ij.x_ij) x_ij; symmetric
/// positive definite.
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
    vectors.inverse_diagonal[i] = 1 / (mass[i] + gamma * (c_sum_[i] + d_sum_[i] / D));
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
