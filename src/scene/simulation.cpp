// SPDX-License-Identifier: MIT
#include "meltray/scene/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "meltray/core/errors.hpp"
#include "meltray/terms/bulk_conduction.hpp"
#include "scene/build.hpp"
#include "scene/laser_coupling.hpp"
#include "scene/model.hpp"

namespace meltray::scene {

namespace {

/// Share of the spacing by which lists reach beyond the support: where lists are kept while particles move, and
/// where they are built anew for every step (only what enters the edge of the support during a step is missed).
constexpr double kSkin = 0.25, kSkinOfStep = 0.05;
double skin(const Scene& scene) { return scene.heat.bulk_interval > 0 ? kSkinOfStep : kSkin; }
/// Bulk conduction looks for newly warm particles every so many exchanges.
constexpr int kExchangesPerBuild = 5;
/// Faster than this a particle is a numerical failure [m/s].
constexpr double kRunaway = 1000;
/// Enthalpy beyond which heat has run away: some 100,000 K in a metal [J/kg].
constexpr double kHottest = 1e8;
/// Partitions of "auto" terms are reconsidered every so many steps.
constexpr std::int64_t kPartitionSteps = 10;

}  // namespace

double EnergyBudget::relative_error() const {
  const double change = stored - initial;
  const double supplied = laser + boundary - evaporation - radiation - ejected - cropped - clamped;
  // Below a thousandth of what is stored, round-off of the store would pass for an error of the budget.
  double largest = std::max(std::abs(change), 1e-3 * std::abs(stored));
  for (double item : {laser, boundary, evaporation, radiation, ejected, cropped, clamped})
    largest = std::max(largest, std::abs(item));
  return largest > 0 ? std::abs(change - supplied) / largest : 0.0;
}

struct Simulation::Impl {
  explicit Impl(Scene s)
      : scene(std::move(s)),
        constants(build_constants(scene)),
        particles(build_particles(scene, constants)),
        selector(build_grid(scene, constants, skin(scene) * constants.spacing), particles),
        model(scene, constants, timers),
        integrator(scene.time.integrator) {
    model.counters = &counters;
    if (scene.laser) laser.emplace(scene, constants);
    if (scene.heat.bulk_interval > 0 && constants.any_isothermal)
      throw UsageError(
          "heat.bulk_interval_s: found > 0 with a face that holds a temperature; allowed: 0 in such a scene");
    on_surface.assign(particles.size(), 0);
    in_state.assign(particles.size(), 0);
    next_bulk = scene.heat.bulk_interval;
  }

  void begin();
  void select();
  void finish_patch();
  StepInfo step(double t_stop);
  void check(const StepReport& report);
  void book(const StepReport& report);
  void change_phases(double dt);
  void remove_escaped();
  void exchange_bulk(double until);
  double stored_energy() const;
  Vec3 liquid_momentum() const;

  Scene scene;
  terms::SceneConstants constants;
  Timers timers;
  Particles particles;
  PatchSelector selector;
  Model model;
  Integrator integrator;
  std::optional<LaserCoupling> laser;
  terms::BulkConduction bulk;
  std::int64_t bulk_exchanges = 0;
  double time = 0, next_bulk = 0, bulk_from = 0, last_dt = 0, evaporative_loss = 0;
  bool begun = false, lists_valid = false;
  double list_motion = 0;

  std::vector<double> y;
  std::vector<StateField> fields;
  std::vector<std::uint8_t> on_surface, in_state, extra;
  std::vector<Index> in_state_list, surface_list;
  Counters counters;
  EnergyBudget energy;
  MomentumBudget momentum;
  MassBudget mass;
};

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

/// Selects the patch, builds its lists, and prepares the stage. Lists of a scene at rest are kept.
void Simulation::Impl::select() {
  const auto timer = timers.measure(Part::neighbours);
  const bool everything = scene.heat.bulk_interval <= 0;
  if (lists_valid && everything && list_motion < 0.5 * skin(scene) * constants.spacing) {
    // Same particles, same lists; the store may hold corrected positions and enthalpies.
    reload(particles, model.patch);
  } else {
    if (everything)
      selector.select_all(particles, model.patch);
    else
      selector.select_near_melt(particles, laser ? std::span<const Index>(laser->lit()) : std::span<const Index>{},
                                model.patch);
    const Index n = model.patch.size();
    extra.assign(n, 0);
    const bool heats = scene.terms.conduction || scene.laser || scene.terms.evaporation || scene.terms.radiation;
    if (everything && heats) {
      for (Index i = 0; i < n; ++i) extra[i] = !model.patch.wall[i];
    } else if (laser) {
      for (Index i : laser->lit()) in_state[i] |= 2;
      for (Index i = 0; i < n; ++i) extra[i] = (in_state[model.patch.global[i]] & 2) != 0;
      for (Index i : laser->lit()) in_state[i] &= 1;
    }
    model.pairs.build(model.patch, selector.grid(), skin(scene) * constants.spacing, extra);
    ++counters.list_builds;
    lists_valid = true;
    list_motion = 0;
  }
  const Index n = model.patch.size();
  const auto& wall_of_melt = model.pairs.next_to_melt();
  model.stage.heat.assign(n, 0);
  for (Index i = 0; i < n; ++i)
    model.stage.heat[i] = !model.patch.wall[i] && (extra[i] || model.patch.liquid[i] || wall_of_melt[i]);
  terms::prepare_stage(model.stage);
  if (!everything) {
    for (Index g : in_state_list) in_state[g] = 0;
    in_state_list.clear();
    for (Index i : model.stage.heated) {
      in_state[model.patch.global[i]] = 1;
      in_state_list.push_back(model.patch.global[i]);
    }
  }
  model.invalidate();
}

StepInfo Simulation::Impl::step(double t_stop) {
  begin();
  if (laser && laser->due(time, 0.0)) {
    const auto timer = timers.measure(Part::laser);
    const bool first = laser->lit().empty();
    laser->trace(time, selector, particles);
    lists_valid = lists_valid && !first;
  }
  select();
  model.pack(y, fields);
  model.evaluate(time, y.data());
  if (laser) {
    const auto timer = timers.measure(Part::laser);
    laser->deposit(model.stage, model.laser_power);
  }
  if (counters.steps % kPartitionSteps == 0) {
    double expected = integrator.proposed_step();
    if (!(expected > 0)) expected = scene.time.integrator.fixed_step;
    for (const StepLimit& limit : model.step_limits())
      if (limit.name != "viscous" && limit.name != "thermal" && limit.name != "evaporation")
        expected = expected > 0 ? std::min(expected, limit.seconds) : limit.seconds;
    model.choose_partitions(expected > 0 ? expected : t_stop - time);
  }

  StepReport report;
  {
    const auto timer = timers.measure(Part::integrator);
    report = integrator.step(model, fields, time, t_stop, y);
  }
  if (model.flows() && scene.flow.projection == Projection::step)
    model.project(report.t, report.dt, y);
  else
    model.evaluate(report.t, y.data());
  check(report);
  time = report.t;
  last_dt = report.dt;
  book(report);
  write_back(model.patch, particles);
  finish_patch();
  change_phases(report.dt);
  if (model.flows()) remove_escaped();
  if (scene.heat.bulk_interval > 0 && scene.terms.conduction) exchange_bulk(time);
  if (model.flows() && !model.stage.moving.empty()) {
    const double motion = report.dt * parallel_max(static_cast<std::ptrdiff_t>(model.stage.moving.size()), 0.0,
                                                   [&](std::ptrdiff_t k) {
      const Index i = model.stage.moving[k];
      double v2 = 0;
      for (int c = 0; c < constants.dim; ++c) v2 += model.patch.v[c][i] * model.patch.v[c][i];
      return std::sqrt(v2);
    });
    list_motion += motion;
    if (laser) laser->add_motion(motion);
  }
  ++counters.limiter[std::string(report.limiter)];
  return {time, report.dt, std::string(report.limiter)};
}

/// Stops at the first particle of the patch that is not finite or runs away, before anything reaches the store.
/// Names the particle, its surroundings, and the term that pulled hardest at it in the last accepted state.
void Simulation::Impl::check(const StepReport& report) {
  const Patch& p = model.patch;
  const int dim = constants.dim;
  const auto bad = [&](Index i) {
    double v2 = 0, x2 = 0;
    for (int c = 0; c < dim; ++c) {
      v2 += p.v[c][i] * p.v[c][i];
      x2 += p.x[c][i] * p.x[c][i];
    }
    return !(v2 < kRunaway * kRunaway) || !std::isfinite(x2) || !(std::abs(p.h[i]) < kHottest);
  };
  Index first = -1;
  for (Index i : model.flows() ? model.stage.moving : model.stage.heated)
    if (bad(i)) {
      first = i;
      break;
    }
  for (Index i : model.stage.heated)
    if (first < 0 && !(std::abs(p.h[i]) < kHottest)) first = i;
  if (first < 0) return;
  std::string text = fmt::format(
      "particle {} is not finite or runs away at t = {:.9g} s (step {:.3g} s): position ({:.6g}, {:.6g}, {:.6g}) m, "
      "velocity ({:.4g}, {:.4g}, {:.4g}) m/s, enthalpy {:.5g} J/kg, {} neighbours, pressure {:.4g} Pa, surface "
      "pressure {:.4g} Pa",
      p.global[first], report.t, report.dt, p.x[0][first], p.x[1][first], dim == 3 ? p.x[2][first] : 0.0,
      p.v[0][first], p.v[1][first], dim == 3 ? p.v[2][first] : 0.0, p.h[first],
      model.pairs.end(first) - model.pairs.begin(first), p.pressure[first], model.stage.surface_pressure[first]);
  const Index particle = p.global[first];
  lists_valid = false;
  select();
  model.pack(y, fields);
  model.evaluate(time, y.data());
  for (Index i : model.stage.moving)
    if (model.patch.global[i] == particle) text += "; " + model.blame(i, report.dt);
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
  momentum.pressure += crossed.pressure + model.pressure_impulse;
  ++counters.steps;
  counters.rejected += report.rejected;
  counters.liquid_particle_steps += static_cast<std::int64_t>(model.stage.moving.size());
}

/// Output fields of the patch: temperature and who is on the surface.
void Simulation::Impl::finish_patch() {
  for (Index g : surface_list) on_surface[g] = 0;
  surface_list.clear();
  for (Index i = 0; i < model.patch.size(); ++i) {
    const Index g = model.patch.global[i];
    if (model.stage.heat[i]) particles.temperature[g] = constants.material.temperature(model.patch.h[i]);
    if (model.stage.surface[i] > 0.5) {
      on_surface[g] = 1;
      surface_list.push_back(g);
    }
  }
}

/// Melting above the liquidus, solidification below the solidus on something solid (a drop in flight stays
/// liquid until it touches). Frozen over a step, updated between steps.
void Simulation::Impl::change_phases(double) {
  if (!scene.terms.melting) return;
  const auto timer = timers.measure(Part::phase);
  const double liquidus = constants.material.enthalpy_liquidus(), solidus = constants.material.enthalpy_solidus();
  const double contact2 = 2.25 * constants.spacing * constants.spacing;
  for (Index i : model.stage.heated) {
    const Index g = model.patch.global[i];
    const double h = model.patch.h[i];
    if (!model.patch.liquid[i] && h >= liquidus) {
      selector.melted(particles, g);
      particles.phase[g] = static_cast<std::uint8_t>(Phase::liquid);
      particles.flags[g] |= kWasLiquid;
      lists_valid = lists_valid && !model.flows();
    } else if (model.patch.liquid[i] && h <= solidus) {
      bool touches = !model.flows();
      sph::with_dim(constants.dim, [&](auto d) {
        model.pairs.for_row<d>(i, [&](const sph::Pair<d>& p) {
          touches = touches || (!model.patch.liquid[p.j] && p.r2() < contact2);
        });
      });
      if (!touches) continue;
      for (int c = 0; c < constants.dim; ++c) {
        momentum.phase_change[c] -= particles.mass[g] * particles.v[c][g];
        particles.v[c][g] = 0;
      }
      selector.solidified(particles, g);
      particles.phase[g] = static_cast<std::uint8_t>(Phase::solid);
      particles.flags[g] |= kResolidified;
      lists_valid = lists_valid && !model.flows();
    }
  }
}

/// Liquid that leaves the box through a free face is ejected; through a wall it is a loss of the cropping and
/// counts as removed. Periodic directions wrap around.
void Simulation::Impl::remove_escaped() {
  for (Index i : model.stage.moving) {
    const Index g = model.patch.global[i];
    bool outside = false, through_wall = false;
    for (int c = 0; c < constants.dim; ++c) {
      double& x = particles.x[c][g];
      const double period = selector.grid().period()[c];
      if (period > 0) {
        x -= period * std::floor((x - scene.domain.min[c]) / period);
        continue;
      }
      const bool below = x < scene.domain.min[c], above = x > scene.domain.max[c];
      if (!below && !above) continue;
      const int face = 2 * (constants.dim == 2 && c == 1 ? 2 : c) + (above ? 1 : 0);
      outside = true;
      through_wall = through_wall || scene.domain.faces[face].kind == FaceKind::wall;
    }
    if (!outside) continue;
    particles.flags[g] |= kRemoved;
    (through_wall ? energy.cropped : energy.ejected) += particles.mass[g] * particles.h[g];
    (through_wall ? mass.cropped : mass.ejected) += particles.mass[g];
    ++(through_wall ? counters.removed : counters.ejected);
    for (int c = 0; c < constants.dim; ++c) momentum.ejected[c] += particles.mass[g] * particles.v[c][g];
    lists_valid = false;
  }
}

void Simulation::Impl::exchange_bulk(double until) {
  if (until < next_bulk) return;
  const auto timer = timers.measure(Part::heat);
  if (bulk_exchanges++ % kExchangesPerBuild == 0)
    bulk.build(constants, selector, particles, scene.heat.initial_temperature);
  bulk.exchange(constants, until - bulk_from, in_state, particles);
  bulk_from = until;
  next_bulk = until + scene.heat.bulk_interval;
}

Simulation::Simulation(Scene scene) : impl_(std::make_unique<Impl>(std::move(scene))) {}
Simulation::~Simulation() = default;

const Scene& Simulation::scene() const { return impl_->scene; }
double Simulation::time() const { return impl_->time; }
StepInfo Simulation::step(double t_stop) { return impl_->step(t_stop); }
const Particles& Simulation::particles() const { return impl_->particles; }
Particles& Simulation::particles() { return impl_->particles; }
const std::vector<std::uint8_t>& Simulation::on_surface() const { return impl_->on_surface; }
Timers& Simulation::timers() { return impl_->timers; }
double Simulation::evaporative_loss() const { return impl_->evaporative_loss; }
std::size_t Simulation::active_count() const { return impl_->model.stage.heated.size(); }
const laser::Tracer* Simulation::tracer() const { return impl_->laser ? &impl_->laser->tracer() : nullptr; }
const laser::Beam* Simulation::beam() const { return impl_->laser ? &impl_->laser->beam() : nullptr; }

EnergyBudget Simulation::energy() const {
  impl_->begin();
  EnergyBudget e = impl_->energy;
  e.stored = impl_->stored_energy();
  return e;
}

MomentumBudget Simulation::momentum() const {
  MomentumBudget m = impl_->momentum;
  m.current = impl_->liquid_momentum();
  return m;
}

MassBudget Simulation::mass() const {
  impl_->begin();
  MassBudget m = impl_->mass;
  m.current = 0;
  const Particles& p = impl_->particles;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (!p.is_wall(i) && !p.has(i, kRemoved)) m.current += p.mass[i];
  return m;
}

LaserBudget Simulation::laser_budget() const { return impl_->laser ? impl_->laser->budget() : LaserBudget{}; }
LaserState Simulation::laser_state() const {
  return impl_->laser ? impl_->laser->state(impl_->time) : LaserState{};
}

Counters Simulation::counters() const {
  Counters c = impl_->counters;
  const IntegratorCounters& i = impl_->integrator.counters();
  c.explicit_evals = i.explicit_evals;
  c.implicit_evals = i.implicit_evals;
  c.linear_solves = i.linear_solves;
  return c;
}

std::size_t Simulation::liquid_count() const {
  std::size_t n = 0;
  for (Index i : impl_->selector.moving()) n += !impl_->particles.has(i, kRemoved);
  return n;
}

std::vector<StepLimit> Simulation::step_limits() {
  Impl& s = *impl_;
  s.begin();
  s.select();
  s.model.pack(s.y, s.fields);
  s.model.evaluate(s.time, s.y.data());
  return s.model.step_limits();
}

std::vector<std::pair<std::string, std::size_t>> Simulation::memory() const {
  const Particles& p = impl_->particles;
  return {{"particles", p.size() * (2 * p.dim + 5) * sizeof(double) + 3 * p.size()},
          {"pair lists", impl_->model.pairs.bytes()},
          {"bulk conduction", impl_->bulk.bytes()},
          {"state vectors", impl_->y.capacity() * sizeof(double) * 20}};
}

void Simulation::archive(Archive& a) {
  Impl& s = *impl_;
  s.begin();
  s.particles.archive(a);
  a.value("time", s.time);
  a.value("next_bulk", s.next_bulk);
  a.value("bulk_from", s.bulk_from);
  a.value("last_dt", s.last_dt);
  a.value("evaporative_loss", s.evaporative_loss);
  a.value("largest_acceleration", s.model.largest_acceleration);
  for (auto [name, item] : {std::pair{"initial", &s.energy.initial}, {"laser", &s.energy.laser},
                            {"boundary", &s.energy.boundary}, {"evaporation", &s.energy.evaporation},
                            {"radiation", &s.energy.radiation}, {"ejected", &s.energy.ejected},
                            {"cropped", &s.energy.cropped},
                            {"clamped", &s.energy.clamped}, {"undeposited", &s.energy.undeposited}})
    a.value(std::string("energy/") + name, *item);
  for (auto [name, item] : {std::pair{"initial", &s.mass.initial}, {"ejected", &s.mass.ejected},
                            {"cropped", &s.mass.cropped},
                            {"evaporated", &s.mass.evaporated_not_removed}})
    a.value(std::string("mass/") + name, *item);
  for (auto [name, item] : {std::pair{"initial", &s.momentum.initial}, {"gravity", &s.momentum.gravity},
                            {"surface", &s.momentum.surface}, {"pressure", &s.momentum.pressure},
                            {"viscosity", &s.momentum.viscosity}, {"phase_change", &s.momentum.phase_change},
                            {"shifting", &s.momentum.shifting},
                            {"ejected", &s.momentum.ejected}})
    for (int c = 0; c < 3; ++c) a.value(fmt::format("momentum/{}_{}", name, c), (*item)[c]);
  Counters& k = s.counters;
  for (auto [name, item] :
       {std::pair{"steps", &k.steps}, {"rejected", &k.rejected}, {"pressure_solves", &k.pressure_solves},
        {"pressure_iterations", &k.pressure_iterations}, {"pressure_at_limit", &k.pressure_at_limit},
        {"heat_iterations", &k.heat_iterations}, {"viscous_iterations", &k.viscous_iterations},
        {"list_builds", &k.list_builds}, {"liquid_particle_steps", &k.liquid_particle_steps}, {"clamped", &k.clamped},
        {"removed", &k.removed}, {"ejected", &k.ejected}})
    a.value(std::string("counters/") + name, *item);
  std::string limiters;
  for (const auto& [name, count] : k.limiter) limiters += fmt::format("{}={};", name, count);
  a.value("counters/limiter", limiters);
  Partitions& part = s.model.partitions;
  for (auto [name, item] : {std::pair{"conduction", &part.conduction}, {"viscosity", &part.viscosity},
                            {"interface_viscosity", &part.interface_viscosity}, {"losses", &part.losses}}) {
    std::int64_t value = *item;
    a.value(std::string("partitions/") + name, value);
    *item = value != 0;
  }
  s.integrator.archive(a);
  if (s.laser) s.laser->archive(a);

  // From here on a run that goes on and one that is resumed are in the same state: everything derived is rebuilt.
  s.lists_valid = false;
  s.bulk_exchanges = 0;
  s.model.invalidate();
  if (!a.loading()) {
    s.selector = PatchSelector(s.selector.grid(), s.particles);
    return;
  }
  k.limiter.clear();
  for (std::size_t at = 0; at < limiters.size();) {
    const auto equals = limiters.find('=', at), end = limiters.find(';', at);
    k.limiter[limiters.substr(at, equals - at)] = std::stoll(limiters.substr(equals + 1, end - equals - 1));
    at = end + 1;
  }
  s.selector = PatchSelector(s.selector.grid(), s.particles);
  s.on_surface.assign(s.particles.size(), 0);
  s.in_state.assign(s.particles.size(), 0);
  s.in_state_list.clear();
  s.surface_list.clear();
}

std::vector<TermInfo> Simulation::terms() const {
  const Scene& s = impl_->scene;
  const Partitions& p = impl_->model.partitions;
  const auto side = [](bool implicit_part, PartitionChoice c) {
    return std::string(implicit_part ? "implicit" : "explicit") +
           (c == PartitionChoice::automatic ? " (auto)" : "");
  };
  const auto info = [](const char* name, bool active, std::string where) {
    return TermInfo{name, active, active ? std::move(where) : "skipped: not in this scene"};
  };
  const std::string projected = s.flow.projection == Projection::step ? "projected once a step" : "projected in every stage";
  return {info("conduction", s.terms.conduction, side(p.conduction, s.time.conduction)),
          info("viscosity", s.terms.viscosity, side(p.viscosity, s.time.viscosity)),
          info("interface_viscosity", s.terms.interface_viscosity, side(p.interface_viscosity, s.time.interface_viscosity)),
          info("pressure", s.terms.pressure, projected),
          info("surface_tension", s.terms.surface_tension, projected),
          info("wetting", s.terms.wetting, projected),
          info("marangoni", s.terms.marangoni, "explicit"),
          info("recoil", s.terms.recoil, projected),
          info("evaporation", s.terms.evaporation, side(p.losses, s.time.evaporation)),
          info("radiation", s.terms.radiation, side(p.losses, s.time.evaporation)),
          info("gravity", s.terms.gravity, "explicit"),
          info("buoyancy", s.terms.buoyancy, "explicit"),
          info("shifting", s.flow.shifting > 0, "explicit"),
          info("laser", s.laser.has_value(), "explicit, frozen over a step"),
          info("melting", s.terms.melting, "between steps")};
}

}  // namespace meltray::scene
