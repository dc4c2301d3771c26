// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "meltray/core/errors.hpp"
#include "scene/model.hpp"

namespace meltray::scene {

namespace {

/// What each term does to a particle, with its name.
using Shares = std::vector<std::pair<double, std::string>>;

/// "pressure 3e+06 m/s^2, ...".
std::string largest_first(Shares shares, const char* unit) {
  std::sort(shares.begin(), shares.end(),
            [](const auto& a, const auto& b) { return std::abs(a.first) > std::abs(b.first); });
  std::string text;
  for (const auto& [size, name] : shares)
    text += fmt::format("{}{} {:.3g} {}", text.empty() ? "" : ", ", name, size, unit);
  return text;
}

}  // namespace

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

std::string Model::blame(Index i, double dt) {
  Shares pulls;
  const auto pull = [&](const char* name, auto&& add) {
    terms::Rates rates = cleared_rates();
    add(rates.acceleration);
    double a2 = 0;
    for (int c = 0; c < constants_.dim; ++c) a2 += acceleration_[c][i] * acceleration_[c][i];
    pulls.emplace_back(std::sqrt(a2), name);
  };
  if (viscous(false).any()) pull("explicit viscosity", [&](auto& a) { add_viscous(false, a); });
  if (viscous(true).any()) pull("implicit viscosity", [&](auto& a) { add_viscous(true, a); });
  pull("gravity and buoyancy", [&](auto& a) { buoyancy_.add_acceleration(stage, a); });
  if (scene_.terms.marangoni) pull("marangoni", [&](auto& a) { marangoni_.add_acceleration(stage, a); });
  if (shifting_.coefficient > 0)
    pull("shifting", [&](auto& a) {
      for (int c = 0; c < constants_.dim; ++c) clear(transport_[c], stage.size());
      shifting_.add_rates(stage, view(transport_), a);
    });
  update_surface_pressure();
  if (weakly_compressible()) {
    density_rate_.resize(stage.size());
    const double alpha = std::exchange(acoustic_->artificial.alpha, 0.0);
    acoustic_->evaluate(stage);
    pull("pressure", [&](auto& a) { acoustic_->add_rates(stage, density_rate_.data(), a); });
    if (needs_surface())
      pull("surface force", [&](auto& a) { acoustic_->force.add_surface_force(stage, a); });
    acoustic_->artificial.alpha = alpha;
    acoustic_->evaluate(stage);
    if (alpha > 0)
      pull("pressure with artificial viscosity",
           [&](auto& a) { acoustic_->add_rates(stage, density_rate_.data(), a); });
  } else {
    projection.assemble(stage);
  }
  if (!weakly_compressible() && projection.rows() > 0) {
    projection.divergence(stage, view(static_cast<const Patch&>(patch).v), source_);
    for (double& s : source_) s /= dt;
    projection.solve(stage, source_, projection_options_);
    pull("pressure and surface force", [&](auto& a) { add_projected_pressure(a); });
  }
  return "accelerations in the last accepted state: " + largest_first(std::move(pulls), "m/s^2");
}

double Model::largest_speed(const std::vector<Index>& which, bool with_loose) const {
  return parallel_max(static_cast<std::ptrdiff_t>(which.size()), 0.0, [&](std::ptrdiff_t k) {
    const Index i = which[k];
    if (stage.loose[i] && !with_loose) return 0.0;
    double v2 = 0;
    for (int c = 0; c < constants_.dim; ++c) v2 += patch.v[c][i] * patch.v[c][i];
    return std::sqrt(v2);
  });
}

std::vector<StepLimit> Model::step_limits() {
  std::vector<StepLimit> limits;
  const Time& time = scene_.time;
  const double h = constants_.smoothing, rho = constants_.density;
  // The explicit relaxation of the divergence, div v / tau: beyond tau it overshoots.
  if (flows() && !weakly_compressible() && scene_.flow.projection == Projection::stage)
    limits.push_back({divergence_time, "divergence"});
  if (flows() && !stage.moving.empty()) {
    const double speed = largest_speed(stage.moving, false);
    if (speed > 0) limits.push_back({time.cfl_advective * h / speed, "advective"});
    if (weakly_compressible()) limits.push_back({acoustic_step(speed), "acoustic"});
    if (scene_.terms.surface_tension) {
      const double sigma = constants_.material.sigma(constants_.melting_temperature());
      limits.push_back({time.cfl_capillary * std::sqrt(rho * h * h * h / (2 * M_PI * sigma)), "capillary"});
    }
    if (largest_acceleration > 0)
      limits.push_back({time.cfl_force * std::sqrt(h / largest_acceleration), "force"});
    if (viscous(false).any()) {
      const double rate = viscous_operator(false).rate(stage);
      if (rate > 0) limits.push_back({time.cfl_viscous / rate, "viscous"});
    }
  }
  if (has_elastic_solid() && !stage.elastic.empty()) limits.push_back({elastic_step(), "elastic"});
  if (scene_.terms.conduction && !partitions.conduction && !stage.heated.empty()) {
    const double rate = conduction_operator().rate(stage);
    if (rate > 0) limits.push_back({time.cfl_thermal / rate, "thermal"});
  }
  if ((scene_.terms.evaporation || scene_.terms.radiation) && !partitions.losses) {
    const double rate = losses_.rate(stage);
    if (rate > 0) limits.push_back({time.cfl_thermal / rate, "evaporation"});
  }
  if (!laser_power.empty()) {
    const double hottest = parallel_max(
        static_cast<std::ptrdiff_t>(stage.heated.size()), 0.0,
        [&](std::ptrdiff_t k) { return laser_power[stage.heated[k]] / patch.mass[stage.heated[k]]; });
    if (hottest > 0)
      limits.push_back({time.laser_heating * constants_.material.heat_capacity_solid / hottest, "laser"});
  }
  if (scene_.laser && scene_.laser->beam.feed > 0)
    limits.push_back(
        {time.beam_travel * 0.5 * scene_.laser->beam.focal_diameter / scene_.laser->beam.feed, "beam"});
  return limits;
}

std::string Model::blame_heat(Index i) {
  Shares sources;
  const auto source = [&](const char* name, auto&& add) {
    terms::Rates rates = cleared_rates();
    add(rates.heating);
    sources.emplace_back(heating_[i], name);
  };
  terms::Crossings ignored;
  if (scene_.terms.conduction) {
    conduction_.assemble(stage);
    source("conduction", [&](double* heating) { conduction_.add_heating(stage, heating); });
  }
  if (scene_.terms.evaporation || scene_.terms.radiation)
    source("evaporation and radiation",
           [&](double* heating) { losses_.add_heating(stage, heating, ignored); });
  if (!laser_power.empty()) sources.emplace_back(laser_power[i] / patch.mass[i], "laser");
  return "heating in the last accepted state: " + largest_first(std::move(sources), "W/kg");
}

StepLimit Model::stable_step(double t, const double* y) {
  evaluate(t, y);
  StepLimit least;
  for (const StepLimit& limit : step_limits()) {
    if (std::isnan(limit.seconds)) return limit;  // it ends the run
    if (limit.seconds < least.seconds) least = limit;
  }
  return least;
}

void Model::choose_partitions(double dt) {
  if (!has_two_sides(scene_.time.integrator.method)) return;
  // An explicit term is stable below 1/rate; it moves to the implicit side when it would set the step, and
  // back when it is well below, so that the choice does not flicker.
  const auto choose = [&](PartitionChoice choice, bool& implicit_part, auto&& rate) {
    if (choice != PartitionChoice::automatic) return;
    const double stiffness = rate() * dt;
    if (stiffness > 0.6) implicit_part = true;
    if (stiffness < 0.3) implicit_part = false;
  };
  const Time& time = scene_.time;
  if (scene_.terms.conduction && !stage.heated.empty())
    choose(time.conduction, partitions.conduction, [&] { return conduction_operator().rate(stage); });
  if (scene_.terms.evaporation || scene_.terms.radiation)
    choose(time.evaporation, partitions.losses, [&] { return losses_.rate(stage); });
  if (!flows() || stage.moving.empty()) return;
  const Partitions before = partitions;
  const auto rate_of = [&](bool implicit_part, terms::ViscousChoice part) {
    return viscous_operator(implicit_part).rate(stage, part);
  };
  if (scene_.terms.interface_viscosity)
    choose(time.interface_viscosity, partitions.interface_viscosity, [&] {
      return rate_of(before.interface_viscosity, {false, true});
    });
  // Beside an implicit interface viscosity the physical one costs least in the same operator.
  const bool joins = scene_.terms.interface_viscosity && partitions.interface_viscosity;
  if (scene_.terms.viscosity && time.viscosity == PartitionChoice::automatic && joins)
    partitions.viscosity = true;
  else if (scene_.terms.viscosity)
    choose(time.viscosity, partitions.viscosity, [&] { return rate_of(before.viscosity, {true, false}); });
  if (partitions != before) implicit_viscous_valid_ = explicit_viscous_valid_ = false;
}

}  // namespace meltray::scene
