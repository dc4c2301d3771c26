// SPDX-License-Identifier: MIT
#include <cmath>

#include "scene/model.hpp"

/// Step limits of the terms, and on which side of a split method each is integrated.
namespace meltray::scene {

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
