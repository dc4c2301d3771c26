// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/simulation_impl.hpp"

namespace meltray::scene {

namespace {

/// Faster than this a particle is a numerical failure [m/s].
constexpr double kRunaway = 1000;
/// Enthalpy beyond which heat has run away: some 100,000 K in a metal [J/kg].
constexpr double kHottest = 1e8;
/// Below zero by this share of the melting temperature a temperature is a numerical failure; what overshoots
/// at a wall at 0 is less.
constexpr double kColdest = 0.05;
/// Partitions of "auto" terms are reconsidered, and the density is looked at, every so many steps.
constexpr std::int64_t kPartitionSteps = 10, kDensitySteps = 10;

}  // namespace

/// Initial totals, once the caller has set the initial conditions.
void Simulation::Impl::begin() {
  if (begun) return;
  begun = true;
  energy.initial = stored_energy();
  momentum.initial = liquid_momentum();
  mass.initial = 0;
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (!particles.is_wall(i)) mass.initial += particles.mass[i];
}

double Simulation::Impl::stored_energy() const {
  return parallel_sum(static_cast<std::ptrdiff_t>(particles.size()), [&](std::ptrdiff_t i) {
    return particles.is_wall(i) || particles.has(i, kRemoved) ? 0.0 : particles.mass[i] * particles.h[i];
  });
}

Vec3 Simulation::Impl::liquid_momentum() const {
  Vec3 p = Vec3::Zero();
  for (Index i : selector.moving())
    if (!particles.has(i, kRemoved))
      for (int c = 0; c < particles.dim; ++c) p[c] += particles.mass[i] * particles.v[c][i];
  return p;
}

/// Selects the patch, builds its lists, and prepares the stage. Lists of a scene at rest are kept. True where
/// nothing has moved since the last selection.
bool Simulation::Impl::select() {
  const auto timer = timers.measure(Part::neighbours);
  const bool everything = scene.heat.bulk_interval <= 0;
  if (lists_valid && keeps_lists(scene) && list_motion < 0.5 * skin(scene) * constants.spacing) {
    // Same particles, same lists; the store may hold corrected positions and enthalpies.
    if (!written) reload(particles, model.patch);
    // Nothing melted: the stage stands as well.
    if (model.weakly_compressible()) return false;
    if (written && !model.flows()) return true;
  } else {
    // Without heat nothing happens away from the melt.
    if (everything && model.needs_pairs())
      selector.select_all(particles, model.patch);
    else
      selector.select_near_melt(particles,
                                laser ? std::span<const Index>(laser->lit()) : std::span<const Index>{},
                                model.patch, patch_reach());
    if (model.has_elastic_solid()) selector.mark_elastic(particles, model.patch, scene.flow.elastic_depth);
    const Index n = model.patch.size();
    extra.assign(n, 0);
    if (everything && scene.exchanges_heat()) {
      for (Index i = 0; i < n; ++i) extra[i] = !model.patch.wall[i];
    } else if (laser) {
      for (Index i : laser->lit()) in_state[i] |= 2;
      for (Index i = 0; i < n; ++i) extra[i] = (in_state[model.patch.global[i]] & 2) != 0;
      for (Index i : laser->lit()) in_state[i] &= 1;
    }
    if (model.needs_pairs())
      model.pairs.build(model.patch, selector.grid(), skin(scene) * constants.spacing, list_rows());
    ++counters.list_builds;
    lists_valid = true;
    deposited = false;
    list_motion = 0;
  }
  const Index n = model.patch.size();
  const auto& wall_of_melt = model.pairs.next_to_melt();
  model.stage.heat.assign(n, 0);
  for (Index i = 0; i < n && scene.exchanges_heat(); ++i)
    model.stage.heat[i] = !model.patch.wall[i] && (extra[i] || model.patch.liquid[i] || wall_of_melt[i]);
  terms::prepare_stage(model.stage, model.needs_pairs());
  model.find_pairs(skin(scene) * constants.spacing, selector.grid().period());
  if (!everything) {
    for (Index g : in_state_list) in_state[g] = 0;
    in_state_list.clear();
    for (Index i : model.stage.heated) {
      in_state[model.patch.global[i]] = 1;
      in_state_list.push_back(model.patch.global[i]);
    }
  }
  return false;
}

/// Makes the patch, its lists and its surface those of the particles in the store, and brings the light to
/// them.
void Simulation::Impl::prepare() {
  if (laser && laser->due(time)) {
    const auto timer = timers.measure(Part::laser);
    const bool everything = scene.heat.bulk_interval <= 0, first = laser->lit().empty();
    const std::vector<Index> lit = everything ? std::vector<Index>() : laser->lit();
    laser->trace(time, selector, particles);
    deposited = false;
    lists_valid = lists_valid && !first && (everything || lit == laser->lit());
  }
  const bool rests = select();
  model.evaluate_patch(time, rests);
  if (laser && !(deposited && model.weakly_compressible())) {
    const auto timer = timers.measure(Part::laser);
    laser->deposit(model.stage, model.laser_power);
    deposited = true;
  }
  model.settle_faces();
  if (model.needs_pairs()) mark_surface(model.stage.surface);
  prepared = true;
}

/// Partitions of "auto" terms for the step that is likely to come.
void Simulation::Impl::choose_partitions(double longest) {
  double expected = integrator.proposed_step();
  if (!(expected > 0)) expected = scene.time.integrator.fixed_step;
  for (const StepLimit& limit : model.step_limits())
    if (limit.name != "viscous" && limit.name != "thermal" && limit.name != "evaporation")
      expected = expected > 0 ? std::min(expected, limit.seconds) : limit.seconds;
  model.choose_partitions(expected > 0 ? expected : longest);
}

/// One step: integration from a prepared patch, what happens between steps, and a new patch at the new
/// positions. That patch serves the projection (Eq. (6) makes the velocities at the new positions solenoidal)
/// and the step that follows: each step looks for neighbours and finds the surface once.
StepInfo Simulation::Impl::step(double t_stop) {
  begin();
  if (!prepared) prepare();
  if (laser) t_stop = std::min(t_stop, laser->beam().next_switch(time));
  model.pack(y, fields);
  if (counters.steps % kPartitionSteps == 0) choose_partitions(t_stop - time);
  StepReport report;
  {
    const auto timer = timers.measure(Part::integrator);
    report = integrator.step(model, fields, time, t_stop, y);
  }
  model.unpack(y.data());
  model.update_equation_of_state();
  const double parted = model.keep_apart(report.dt);
  check(report);
  prepared = false;
  time = report.t;
  last_dt = report.dt;
  book(report);
  if (model.has_elastic_solid()) selector.follow(particles, model.patch);
  write_back(model.patch, particles);
  written = true;
  update_temperatures();
  if (model.flows()) remove_escaped();
  change_phases();
  if (scene.heat.bulk_interval > 0 && scene.terms.conduction) exchange_bulk(time);
  note_motion(report.dt, parted);
  prepare();
  if (model.projects_steps()) {
    model.project(report.dt);
    check(report);
    momentum.pressure += model.pressure_impulse;
    write_back(model.patch, particles);
  }
  if (model.weakly_compressible() && counters.steps % kDensitySteps == 0)
    largest_density_variation = std::max(largest_density_variation, density_variation());
  ++counters.limiter[std::string(report.limiter)];
  return {time, report.dt, std::string(report.limiter)};
}

/// How far particles may have moved since the lists were built and the light was traced; `parted` [m] besides
/// what their velocities did.
void Simulation::Impl::note_motion(double dt, double parted) {
  if (!model.flows() || (model.stage.moving.empty() && model.stage.elastic.empty())) return;
  const double fastest =
      std::max(model.largest_speed(model.stage.moving, true), model.largest_speed(model.stage.elastic, true));
  list_motion += dt * fastest + parted;
  // Parting mostly moves particles along the surface, which stays where it is.
  if (laser) laser->add_motion(dt * fastest);
}

/// Stops at the first particle of the patch that is not finite or runs away, before anything reaches the
/// store. Names the particle, its surroundings, and the term that pulled hardest at it in the last accepted
/// state.
void Simulation::Impl::check(const StepReport& report) {
  const Patch& p = model.patch;
  const int dim = constants.dim;
  const double coldest = constants.material.enthalpy(-kColdest * constants.material.solidus);
  const auto bad = [&](Index i) {
    double v2 = 0, x2 = 0;
    for (int c = 0; c < dim; ++c) {
      v2 += p.v[c][i] * p.v[c][i];
      x2 += p.x[c][i] * p.x[c][i];
    }
    return !(v2 < kRunaway * kRunaway) || !std::isfinite(x2) || !(std::abs(p.h[i]) < kHottest) ||
           p.h[i] < coldest;
  };
  Index first = -1;
  for (const auto* which : {&model.stage.moving, &model.stage.elastic, &model.stage.heated}) {
    const auto count = static_cast<std::ptrdiff_t>(which->size());
    if (first >= 0 ||
        parallel_max(count, 0.0, [&](std::ptrdiff_t k) { return bad((*which)[k]) ? 1.0 : 0.0; }) == 0)
      continue;
    first = *std::find_if(which->begin(), which->end(), bad);
  }
  if (first < 0) return;
  const bool cold = p.h[first] < coldest;
  std::string text = fmt::format(
      "particle {} is {} at t = {:.9g} s (step {:.3g} s): position ({:.6g}, {:.6g}, "
      "{:.6g}) m, "
      "velocity ({:.4g}, {:.4g}, {:.4g}) m/s, enthalpy {:.5g} J/kg, {} neighbours, pressure {:.4g} Pa, "
      "surface "
      "pressure {:.4g} Pa",
      p.global[first], cold ? "colder than 0 K" : "not finite or runs away", report.t, report.dt,
      p.x[0][first], p.x[1][first], dim == 3 ? p.x[2][first] : 0.0, p.v[0][first], p.v[1][first],
      dim == 3 ? p.v[2][first] : 0.0, p.h[first], model.pairs.count(first), p.pressure[first],
      model.needs_pairs() ? model.stage.surface_pressure[first] : 0.0);
  const Index particle = p.global[first];
  const bool of_heat = !(std::abs(p.h[first]) < kHottest) || cold;
  lists_valid = false;
  select();
  model.evaluate_patch(time);
  for (Index i : model.stage.moving)
    if (model.patch.global[i] == particle) text += "; " + model.blame(i, report.dt);
  for (Index i : model.stage.heated)
    if (of_heat && model.patch.global[i] == particle) text += "; " + model.blame_heat(i);
  throw NumericalFailure(text);
}

void Simulation::Impl::book(const StepReport& report) {
  const auto crossed = terms::Crossings::read(y.data() + model.crossings_begin());
  energy.evaporation += crossed.evaporation;
  energy.radiation += crossed.radiation;
  energy.boundary += crossed.boundary;
  energy.laser += crossed.laser;
  mass.evaporated_not_removed += crossed.evaporated_mass;
  evaporative_loss = crossed.evaporation / report.dt;
  if (laser) {
    laser->book(report.dt);
    energy.undeposited += report.dt * laser->undeposited();
  }
  momentum.gravity += crossed.gravity;
  momentum.surface += crossed.surface;
  momentum.viscosity += crossed.viscosity;
  momentum.shifting += crossed.shifting;
  momentum.pressure += crossed.pressure;
  ++counters.steps;
  counters.rejected += report.rejected;
  counters.liquid_particle_steps += static_cast<std::int64_t>(model.stage.moving.size());
}

void Simulation::Impl::update_temperatures() {
  parallel_for(static_cast<std::ptrdiff_t>(model.stage.heated.size()), [&](std::ptrdiff_t k) {
    const Index i = model.stage.heated[k];
    particles.temperature[model.patch.global[i]] = constants.material.temperature(model.patch.h[i]);
  });
}

/// Remembers who is on the surface, for output.
void Simulation::Impl::mark_surface(const std::vector<double>& weight) {
  for (Index g : surface_list) on_surface[g] = 0;
  surface_list.clear();
  for (Index i = 0; i < model.patch.size(); ++i)
    if (weight[i] > 0.5) {
      on_surface[model.patch.global[i]] = 1;
      surface_list.push_back(model.patch.global[i]);
    }
}

/// The surface of a scene whose steps need none, for output: nothing that steps rest on changes.
void Simulation::Impl::find_surface() {
  if (model.needs_pairs() || !prepared) return;
  std::vector<double> weight;
  terms::find_surface_weights(model.stage, selector.grid(), weight);
  mark_surface(weight);
}

}  // namespace meltray::scene
