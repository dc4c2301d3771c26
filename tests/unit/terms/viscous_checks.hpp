// SPDX-License-Identifier: MIT
#pragma once

#include <catch2/catch.hpp>

#include "meltray/terms/viscosity.hpp"
#include "unit/terms/stage_setup.hpp"

/// What every viscous operator has to fulfil.
namespace meltray::test {

inline Components acceleration(const StageSetup& s, const terms::ViscousOperator& op, const Components& v) {
  Components a = s.zeros();
  op.add_acceleration(s.stage, view(v), view(a));
  return a;
}
inline Components acceleration(const StageSetup& s, const terms::ViscousOperator& op) {
  return acceleration(s, op, s.patch.v);
}

inline double largest(const Components& a) {
  double m = 0;
  for (const auto& c : a)
    for (double x : c) m = std::max(m, std::abs(x));
  return m;
}

/// Sum of m u.w over the moving particles.
inline double work(const StageSetup& s, const Components& u, const Components& w) {
  double sum = 0;
  for (Index i : s.stage.moving)
    for (int c = 0; c < s.constants.dim; ++c) sum += s.patch.mass[i] * u[c][i] * w[c][i];
  return sum;
}

inline Components random_field(const StageSetup& s, std::uint64_t seed) {
  Noise noise(seed);
  Components f = s.zeros();
  for (int c = 0; c < s.constants.dim; ++c)
    for (double& x : f[c]) x = noise();
  return f;
}

/// A jittered block of liquid with free faces on all sides.
inline void fill_jittered_block(StageSetup& s, int cells) {
  const Vec3 max = Vec3::Constant(cells * s.constants.spacing), margin = Vec3::Constant(s.constants.spacing);
  s.fill(Vec3::Zero(), max, 2000);
  s.jitter(0.25);
  s.prepare(-margin, max + margin);
}

inline void check_conservation_and_symmetry(const StageSetup& s, const terms::ViscousOperator& op) {
  const auto u = random_field(s, 11), w = random_field(s, 12);
  const auto au = acceleration(s, op, u), aw = acceleration(s, op, w);
  for (int c = 0; c < s.constants.dim; ++c) {
    double net = 0, gross = 0;
    for (Index i : s.stage.moving) {
      net += s.patch.mass[i] * au[c][i];
      gross += s.patch.mass[i] * std::abs(au[c][i]);
    }
    CHECK(std::abs(net) < 1e-12 * gross);
  }
  CHECK(work(s, u, aw) == Approx(work(s, w, au)).epsilon(1e-10));
  CHECK(work(s, u, au) < 0);
  CHECK(work(s, w, aw) < 0);
}

/// (I - gamma A) x = b with A probed column by column against ViscousOperator::solve, and Gershgorin's bound.
inline void check_solve_against_dense(const StageSetup& s, const terms::ViscousOperator& op, double gamma) {
  const int dim = s.constants.dim;
  const auto n = static_cast<Index>(s.stage.moving.size());
  Eigen::MatrixXd a(dim * n, dim * n);
  for (Index k = 0; k < n; ++k)
    for (int c = 0; c < dim; ++c) {
      Components unit = s.zeros();
      unit[c][s.stage.moving[k]] = 1;
      const auto column = acceleration(s, op, unit);
      for (Index r = 0; r < n; ++r)
        for (int e = 0; e < dim; ++e) a(dim * r + e, dim * k + c) = column[e][s.stage.moving[r]];
    }
  const auto b = random_field(s, 13);
  Eigen::VectorXd rhs(dim * n);
  for (Index r = 0; r < n; ++r)
    for (int e = 0; e < dim; ++e) rhs[dim * r + e] = b[e][s.stage.moving[r]];
  const Eigen::VectorXd exact =
      (Eigen::MatrixXd::Identity(dim * n, dim * n) - gamma * a).partialPivLu().solve(rhs);
  auto x = random_field(s, 14);
  const auto largest_error = [&] {
    double worst = 0;
    for (Index r = 0; r < n; ++r)
      for (int e = 0; e < dim; ++e)
        worst = std::max(worst, std::abs(x[e][s.stage.moving[r]] - exact[dim * r + e]));
    return worst;
  };
  const auto solved = op.solve(s.stage, gamma, view(b), view(x), 1e-12, 2000);
  CHECK(solved.converged);
  CHECK(solved.iterations > 0);
  CHECK(largest_error() < 1e-9 * exact.cwiseAbs().maxCoeff());
  // What the solve reports as the impulse is what the operator gives at the solution.
  const Eigen::VectorXd change = gamma * (a * exact);
  for (int e = 0; e < dim; ++e) {
    double impulse = 0, size = 0;
    for (Index r = 0; r < n; ++r) {
      impulse += s.patch.mass[s.stage.moving[r]] * change[dim * r + e];
      size += std::abs(s.patch.mass[s.stage.moving[r]] * change[dim * r + e]);
    }
    CHECK(std::abs(solved.impulse[e] - impulse) < 1e-9 * size);
  }
  // It stays at the solution, with a loose tolerance as well: the residual must fall from where it started.
  op.solve(s.stage, gamma, view(b), view(x), 1e-3, 2000);
  CHECK(largest_error() < 1e-9 * exact.cwiseAbs().maxCoeff());
  const double fastest = -a.eigenvalues().real().minCoeff();
  CHECK(fastest <= 2 * op.rate(s.stage) * (1 + 1e-9));
}

}  // namespace meltray::test
