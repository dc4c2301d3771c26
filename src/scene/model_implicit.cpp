// SPDX-License-Identifier: MIT
#include <algorithm>

#include "scene/model.hpp"

/// The implicit side of a Model: its rate, and the linear systems of its stages.
namespace meltray::scene {

namespace {

constexpr int kLinearIterations = 500;

}  // namespace

void Model::implicit_rate(double t, const double* y, double* rate) {
  evaluate(t, y);
  terms::Rates rates = cleared_rates();
  terms::Crossings crossings;
  if (flows()) add_forces(rates, true, crossings);
  add_heat(rates, true, crossings);
  finish_rates(y, rate, crossings, false);
}

/// Solves v - gamma A(v) = known for the velocities of the moving particles, one component after the other in
/// `known` and `v`, which holds the start; resting neighbours have the velocities `resting`. Adds gamma times
/// the total force to `impulse`. False without convergence.
bool Model::solve_viscous(double gamma, const double* known, const Components& resting, double* v,
                          Vec3& impulse) {
  const auto timer = timers_.measure(Part::viscosity);
  const auto nm = static_cast<std::ptrdiff_t>(stage.moving.size());
  for (int c = 0; c < constants_.dim; ++c) {
    solve_b_[c].resize(stage.size());
    solve_x_[c] = resting[c];
    parallel_for(nm, [&](std::ptrdiff_t k) {
      const Index i = stage.moving[k];
      solve_b_[c][i] = known[c * nm + k];
      solve_x_[c][i] = v[c * nm + k];
    });
  }
  const terms::ViscousSolve result =
      viscous_operator(true).solve(stage, gamma, view(static_cast<const Components&>(solve_b_)),
                                   view(solve_x_), scene_.time.linear_tolerance, kLinearIterations);
  counters->viscous_iterations += result.iterations;
  for (int c = 0; c < constants_.dim; ++c)
    parallel_for(nm, [&](std::ptrdiff_t k) { v[c * nm + k] = solve_x_[c][stage.moving[k]]; });
  impulse += result.impulse;
  return result.converged;
}

bool Model::solve_linear(double t, double gamma, const double* known, double* z) {
  evaluate(t, known);  // all but velocities are known
  const std::size_t nm = stage.moving.size(), n = crossings_begin(), v = constants_.dim * nm;
  guess_.assign(z + v, z + 2 * v);
  std::copy(known, known + n + terms::Crossings::kCount, z);
  if (nm == 0) return true;
  std::copy(guess_.begin(), guess_.end(), z + v);
  terms::Crossings crossings = terms::Crossings::read(known + n);
  const bool converged = solve_viscous(gamma, known + v, patch.v, z + v, crossings.viscosity);
  crossings.write(z + n);
  return converged;
}

bool Model::solve_implicit(double t, const double* y, double gamma, double* b) {
  evaluate(t, y);
  const std::size_t nm = flows() ? stage.moving.size() : 0, nh = stage.heated.size();
  const int dim = constants_.dim;
  if (nm > 0 && viscous(true).any()) {
    double* const change = b + dim * nm;
    const std::vector<double>& known = guess_;
    guess_.assign(change, change + dim * nm);
    std::fill(change, change + dim * nm, 0.0);
    for (int c = 0; c < dim; ++c) at_rest_[c].assign(stage.size(), 0.0);
    Vec3 impulse = Vec3::Zero();  // Newton's method books the force of the rate itself
    if (!solve_viscous(gamma, known.data(), at_rest_, change, impulse)) return false;
  }
  const bool losses = (scene_.terms.evaporation || scene_.terms.radiation) && partitions.losses;
  const bool conducts = scene_.terms.conduction && partitions.conduction;
  if (!losses && !conducts) return true;
  const auto timer = timers_.measure(Part::heat);
  double* const bh = b + enthalpy_begin();
  loss_slope_.assign(stage.size(), 0.0);
  if (losses) losses_.slope(stage, loss_slope_.data());
  solve_h_x_.assign(stage.size(), 0.0);
  if (conducts) {
    solve_h_b_.assign(stage.size(), 0.0);
    for (std::size_t k = 0; k < nh; ++k) solve_h_b_[stage.heated[k]] = bh[k];
    const int iterations =
        conduction_operator().solve(stage, gamma, loss_slope_.data(), solve_h_b_.data(), solve_h_x_.data(),
                                    scene_.time.linear_tolerance, kLinearIterations);
    if (iterations < 0) return false;
    counters->heat_iterations += iterations;
    for (std::size_t k = 0; k < nh; ++k) bh[k] = solve_h_x_[stage.heated[k]];
  } else {
    for (std::size_t k = 0; k < nh; ++k) {
      const Index i = stage.heated[k];
      bh[k] /= 1 - gamma * loss_slope_[i] / patch.mass[i] * constants_.material.temperature_slope(patch.h[i]);
    }
  }
  return true;
}

}  // namespace meltray::scene
