// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "meltray/core/memory.hpp"
#include "scene/simulation_impl.hpp"

namespace meltray::scene {

double EnergyBudget::relative_error() const {
  const double change = stored - initial;
  const double supplied = laser + boundary - evaporation - radiation - ejected - cropped;
  // Below a thousandth of what is stored, round-off of the store would pass for an error of the budget.
  double largest = std::max(std::abs(change), 1e-3 * std::abs(stored));
  for (double item : {laser, boundary, evaporation, radiation, ejected, cropped})
    largest = std::max(largest, std::abs(item));
  return largest > 0 ? std::abs(change - supplied) / largest : 0.0;
}

Simulation::Simulation(Scene scene) : impl_(std::make_unique<Impl>(std::move(scene))) {}
Simulation::~Simulation() = default;

const Scene& Simulation::scene() const {
  return impl_->scene;
}
double Simulation::time() const {
  return impl_->time;
}
StepInfo Simulation::step(double t_stop) {
  return impl_->step(t_stop);
}
const Particles& Simulation::particles() const {
  return impl_->particles;
}
Particles& Simulation::particles() {
  return impl_->particles;
}
const std::vector<std::uint8_t>& Simulation::on_surface() const {
  impl_->find_surface();
  return impl_->on_surface;
}
Timers& Simulation::timers() {
  return impl_->timers;
}
double Simulation::evaporative_loss() const {
  return impl_->evaporative_loss;
}
std::size_t Simulation::active_count() const {
  return std::max(impl_->model.stage.heated.size(), impl_->model.stage.moving.size());
}
const laser::Tracer* Simulation::tracer() const {
  return impl_->laser ? &impl_->laser->tracer() : nullptr;
}
const laser::Beam* Simulation::beam() const {
  return impl_->laser ? &impl_->laser->beam() : nullptr;
}

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

LaserBudget Simulation::laser_budget() const {
  return impl_->laser ? impl_->laser->budget() : LaserBudget{};
}
LaserState Simulation::laser_state() const {
  return impl_->laser ? impl_->laser->state() : LaserState{};
}

Counters Simulation::counters() const {
  Counters c = impl_->counters;
  const IntegratorCounters& i = impl_->integrator.counters();
  c.explicit_evals = i.explicit_evals;
  c.implicit_evals = i.implicit_evals;
  c.linear_solves = i.linear_solves;
  return c;
}

double Simulation::Impl::density_variation() const {
  if (!model.weakly_compressible()) return 0;
  constexpr double kShare = 0.99;
  std::vector<double> variation;
  for (Index i : selector.moving()) {
    if (particles.has(i, kRemoved)) continue;
    const double rest = scene.flow.thermal_expansion ? scene.material.density_of_t(particles.temperature[i])
                                                     : constants.density;
    variation.push_back(std::abs(particles.density[i] / rest - 1));
  }
  if (variation.empty()) return 0;
  const auto at = variation.begin() + static_cast<std::ptrdiff_t>(kShare * (variation.size() - 1));
  std::nth_element(variation.begin(), at, variation.end());
  return *at;
}

DensityVariation Simulation::density_variation() const {
  return {impl_->density_variation(), impl_->largest_density_variation};
}

std::size_t Simulation::liquid_count() const {
  std::size_t n = 0;
  for (Index i : impl_->selector.moving()) n += !impl_->particles.has(i, kRemoved);
  return n;
}

std::vector<StepLimit> Simulation::step_limits() {
  Impl& s = *impl_;
  s.begin();
  if (!s.prepared) s.prepare();
  return s.model.step_limits();
}

std::vector<std::pair<std::string, std::size_t>> Simulation::memory() const {
  const Impl& s = *impl_;
  const std::size_t entries = s.model.crossings_begin() + terms::Crossings::kCount;
  return {{"particles", s.particles.bytes()},
          {"cells", s.selector.bytes() + held_bytes(s.on_surface, s.in_state)},
          {"patch and stage", s.model.patch.bytes() + s.model.stage.bytes()},
          {"pair lists", s.model.pairs.bytes()},
          {"acoustic pass", s.model.acoustic_bytes()},
          {"terms", s.model.term_bytes()},
          {"bulk conduction", s.bulk.bytes()},
          {"state vectors", entries * sizeof(double) + s.integrator.bytes(entries)}};
}

void Simulation::archive(Archive& a) {
  Impl& s = *impl_;
  s.begin();
  // The file stands in memory before it is written, and all of this is built anew.
  s.lists_valid = s.prepared = false;
  s.model.release();
  s.bulk = {};
  s.integrator.release();
  free_memory(s.y);
  s.particles.archive(a);
  a.value("time", s.time);
  a.value("next_bulk", s.next_bulk);
  a.value("bulk_from", s.bulk_from);
  a.value("last_dt", s.last_dt);
  a.value("evaporative_loss", s.evaporative_loss);
  if (s.model.weakly_compressible()) a.value("largest_density_variation", s.largest_density_variation);
  a.value("largest_acceleration", s.model.largest_acceleration);
  for (auto [name, item] : {std::pair{"initial", &s.energy.initial},
                            {"laser", &s.energy.laser},
                            {"boundary", &s.energy.boundary},
                            {"evaporation", &s.energy.evaporation},
                            {"radiation", &s.energy.radiation},
                            {"ejected", &s.energy.ejected},
                            {"cropped", &s.energy.cropped},
                            {"undeposited", &s.energy.undeposited}})
    a.value(std::string("energy/") + name, *item);
  for (auto [name, item] : {std::pair{"initial", &s.mass.initial},
                            {"ejected", &s.mass.ejected},
                            {"cropped", &s.mass.cropped},
                            {"evaporated", &s.mass.evaporated_not_removed}})
    a.value(std::string("mass/") + name, *item);
  for (auto [name, item] : {std::pair{"initial", &s.momentum.initial},
                            {"gravity", &s.momentum.gravity},
                            {"surface", &s.momentum.surface},
                            {"pressure", &s.momentum.pressure},
                            {"viscosity", &s.momentum.viscosity},
                            {"phase_change", &s.momentum.phase_change},
                            {"shifting", &s.momentum.shifting},
                            {"ejected", &s.momentum.ejected}})
    for (int c = 0; c < 3; ++c) a.value(fmt::format("momentum/{}_{}", name, c), (*item)[c]);
  Counters& k = s.counters;
  for (auto [name, item] : {std::pair{"steps", &k.steps},
                            {"rejected", &k.rejected},
                            {"pressure_solves", &k.pressure_solves},
                            {"pressure_iterations", &k.pressure_iterations},
                            {"pressure_at_limit", &k.pressure_at_limit},
                            {"heat_iterations", &k.heat_iterations},
                            {"viscous_iterations", &k.viscous_iterations},
                            {"list_builds", &k.list_builds},
                            {"liquid_particle_steps", &k.liquid_particle_steps},
                            {"clamped", &k.clamped},
                            {"removed", &k.removed},
                            {"ejected", &k.ejected}})
    a.value(std::string("counters/") + name, *item);
  std::string limiters;
  for (const auto& [name, count] : k.limiter) limiters += fmt::format("{}={};", name, count);
  a.value("counters/limiter", limiters);
  Partitions part = s.model.partitions;
  for (auto [name, item] : {std::pair{"conduction", &part.conduction},
                            {"viscosity", &part.viscosity},
                            {"interface_viscosity", &part.interface_viscosity},
                            {"losses", &part.losses}}) {
    std::int64_t value = *item;
    a.value(std::string("partitions/") + name, value);
    *item = value != 0;
  }
  s.model.take_up(part);
  s.integrator.archive(a);
  if (s.laser) s.laser->archive(a);

  // From here on a run that goes on and one that is resumed are in the same state: everything derived is
  // rebuilt.
  s.lists_valid = s.deposited = s.prepared = s.written = false;
  s.bulk_exchanges = 0;
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
  const bool multirate = s.time.integrator.method == Method::multirate;
  const auto side = [multirate](bool implicit_part, PartitionChoice c) {
    if (multirate) return std::string(implicit_part ? "slow" : "fast");
    return std::string(implicit_part ? "implicit" : "explicit") +
           (c == PartitionChoice::automatic ? " (auto)" : "");
  };
  const auto info = [](const char* name, bool active, std::string where) {
    return TermInfo{name, active, active ? std::move(where) : "skipped: not in this scene"};
  };
  const std::string projected = impl_->model.weakly_compressible()      ? "explicit"
                                : s.flow.projection == Projection::step ? "projected once a step"
                                                                        : "projected in every stage";
  return {info("conduction", s.terms.conduction, side(p.conduction, s.time.conduction)),
          info("viscosity", s.terms.viscosity, side(p.viscosity, s.time.viscosity)),
          info("interface_viscosity", s.terms.interface_viscosity,
               side(p.interface_viscosity, s.time.interface_viscosity)),
          info("pressure", s.terms.pressure,
               impl_->model.weakly_compressible()
                   ? fmt::format("explicit, loops for {}", terms::AcousticPass::instructions())
                   : projected),
          info("density_diffusion",
               impl_->model.weakly_compressible() && s.flow.density_diffusion != DensityDiffusion::none,
               "explicit"),
          info("artificial_viscosity", s.terms.artificial_viscosity, "explicit"),
          info("thermal_expansion", s.flow.thermal_expansion, "explicit"),
          info("elastic_solid", impl_->model.has_elastic_solid(), "explicit"),
          info("surface_tension", s.terms.surface_tension, projected),
          info("wetting", s.terms.wetting, projected),
          info("marangoni", s.terms.marangoni, "explicit"),
          info("recoil", s.terms.recoil, projected),
          info("evaporation", s.terms.evaporation, side(p.losses, s.time.evaporation)),
          info("radiation", s.terms.radiation, side(p.losses, s.time.evaporation)),
          info("gravity", s.terms.gravity, s.weighs() ? "explicit" : "held by the walls"),
          info("buoyancy", s.terms.buoyancy, "explicit"),
          info("shifting", s.flow.shifting > 0, "explicit"),
          info("least_distance", impl_->model.keeps_apart(), "between steps"),
          info("laser", s.laser.has_value(), "explicit, frozen over a step"),
          info("melting", s.terms.melting, "between steps")};
}

}  // namespace meltray::scene
