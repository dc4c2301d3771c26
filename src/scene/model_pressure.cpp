// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "meltray/core/errors.hpp"
#include "scene/model.hpp"

namespace meltray::scene {

void Model::count_solve(const solve::SolveReport& report, double t) {
  ++counters->pressure_solves;
  counters->pressure_iterations += report.iterations;
  if (!std::isfinite(report.residual))
    throw NumericalFailure(
        fmt::format("pressure: the Poisson solve gave a residual of {} at t = {:.9g} s with {} rows",
                    report.residual, t, projection.rows()));
  if (!report.converged) ++counters->pressure_at_limit;
}

void Model::project(double dt) {
  update_surface_pressure();
  const auto timer = timers_.measure(Part::pressure);
  projection.assemble(stage);
  largest_acceleration = 0;
  pressure_impulse = Vec3::Zero();
  if (projection.rows() == 0) return;
  // Eq. (6): div(grad p / rho) = div v* / dt, less the divergence that undoes a density error over
  // drift_time.
  projection.divergence(stage, view(static_cast<const Patch&>(patch).v), source_);
  projection.compression(stage, other_);
  const double relax = 1 / std::max(drift_time, 2 * dt);
  for (Index r = 0; r < projection.rows(); ++r) source_[r] = (source_[r] - relax * other_[r]) / dt;
  count_solve(projection.solve(stage, source_, projection_options_), stage.t);

  for (int c = 0; c < constants_.dim; ++c) clear(acceleration_[c], stage.size());
  add_projected_pressure(view(acceleration_));
  const auto count = static_cast<std::ptrdiff_t>(stage.moving.size());
  pressure_impulse = dt * total_force();
  // Positions moved with the velocities of before: with x^{n+1} = x^n + dt v^n and v^{n+1} = v^n + dt
  // a(x^{n+1}) the two leapfrog (symplectic Euler), and the geometry of the projection is that of the next
  // step.
  for (int c = 0; c < constants_.dim; ++c)
    parallel_for(count, [&](std::ptrdiff_t k) {
      const Index i = stage.moving[k];
      patch.v[c][i] += dt * acceleration_[c][i];
    });
  note_largest_acceleration();
}

bool Model::keeps_apart() const {
  return flows() && !weakly_compressible() && constants_.free_surface && least_distance_.share > 0;
}

double Model::keep_apart(double dt) {
  if (!keeps_apart()) return 0;
  const auto timer = timers_.measure(Part::forces);
  const MutField displacement = view(acceleration_);
  least_distance_.displace(stage, dt, displacement);
  return parallel_max(static_cast<std::ptrdiff_t>(stage.moving.size()), 0.0, [&](std::ptrdiff_t k) {
    const Index i = stage.moving[k];
    double moved2 = 0;
    for (int c = 0; c < constants_.dim; ++c) {
      patch.x[c][i] += displacement[c][i];
      moved2 += displacement[c][i] * displacement[c][i];
    }
    return std::sqrt(moved2);
  });
}

/// -grad p / rho and the surface force.
void Model::add_projected_pressure(const MutField& acceleration) {
  projection.add_acceleration(stage, projection_options_.entry, acceleration);
  if (adds_recoil_slope()) terms::add_recoil_along_surface(stage, recoil_average_, acceleration);
}

/// Of the accelerations gathered so far, without loose drops.
void Model::note_largest_acceleration() {
  const auto count = static_cast<std::ptrdiff_t>(stage.moving.size());
  largest_acceleration = parallel_max(count, 0.0, [&](std::ptrdiff_t k) {
    const Index i = stage.moving[k];
    double a2 = 0;
    for (int c = 0; c < constants_.dim; ++c) a2 += acceleration_[c][i] * acceleration_[c][i];
    return stage.loose[i] ? 0.0 : std::sqrt(a2);
  });
}

void Model::pressure_in_stage(terms::Rates& rates, terms::Crossings& crossings) {
  // Lagrangian particles: D(div v)/Dt = div a + dDiv(v), so that div(grad p/rho) = div f* + dDiv(v) + div
  // v/tau keeps div v = 0 and pulls any error back with the fixed time constant tau.
  update_surface_pressure();
  const auto timer = timers_.measure(Part::pressure);
  projection.assemble(stage);
  if (projection.rows() == 0) return;
  const auto v = view(static_cast<const Patch&>(patch).v);
  // f* holds every acceleration of this stage, those of the implicit side included.
  all_forces_ = acceleration_;
  if (viscous(true).any()) add_viscous(true, view(all_forces_));
  projection.divergence(stage, view(static_cast<const Components&>(all_forces_)), source_);
  projection.divergence_rate(stage, v, other_);
  for (Index r = 0; r < projection.rows(); ++r) source_[r] += other_[r];
  projection.divergence(stage, v, other_);
  for (Index r = 0; r < projection.rows(); ++r) source_[r] += other_[r] / divergence_time;
  projection.compression(stage, other_);
  const double relax = 1 / (divergence_time * drift_time);
  for (Index r = 0; r < projection.rows(); ++r) source_[r] -= relax * other_[r];
  count_solve(projection.solve(stage, source_, projection_options_), stage.t);
  add_projected_pressure(rates.acceleration);
  crossings.pressure = force_gained();
}

}  // namespace meltray::scene
