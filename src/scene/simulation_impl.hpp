// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "meltray/core/errors.hpp"
#include "meltray/scene/simulation.hpp"
#include "meltray/terms/bulk_conduction.hpp"
#include "scene/build.hpp"
#include "scene/laser_coupling.hpp"
#include "scene/model.hpp"

namespace meltray::scene {

/// Share of the spacing by which lists reach beyond the support: where lists are kept while particles move,
/// where they are built anew for every step (only what enters the edge of the support during a step is
/// missed), and where a patch follows the melt in steps at the speed of sound, many of which a list outlasts.
inline constexpr double kSkin = 0.25, kSkinOfStep = 0.05, kSkinOfSound = 0.3;
inline bool follows_melt(const Scene& scene) {
  return scene.heat.bulk_interval > 0;
}
inline bool keeps_lists(const Scene& scene) {
  return !follows_melt(scene) || (scene.terms.pressure && scene.flow.solver == FlowSolver::wcsph);
}
inline double skin(const Scene& scene) {
  return !follows_melt(scene) ? kSkin : keeps_lists(scene) ? kSkinOfSound : kSkinOfStep;
}

/// State of a simulation; its steps are in simulation.cpp, what happens between them in
/// simulation_events.cpp, what it reports and saves in simulation_report.cpp.
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
    on_surface.assign(particles.size(), 0);
    in_state.assign(particles.size(), 0);
    next_bulk = scene.heat.bulk_interval;
  }

  void begin();
  bool select();
  void prepare();
  void choose_partitions(double longest);
  StepInfo step(double t_stop);
  void note_motion(double dt, double parted);
  void update_temperatures();
  void mark_surface(const std::vector<double>& weight);
  void find_surface();
  void check(const StepReport& report);
  void book(const StepReport& report);
  bool touches_solid(Index i) const;
  void change_phases();
  void remove_escaped();
  void exchange_bulk(double until);
  Index patch_reach() const;
  const std::vector<std::uint8_t>& list_rows();
  void release(Index particle);
  double stored_energy() const;
  double density_variation() const;
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
  double largest_density_variation = 0;
  bool begun = false, lists_valid = false;
  bool prepared = false;   ///< patch and surface are those of the particles in the store
  bool written = false;    ///< the store holds what the patch holds
  bool deposited = false;  ///< the laser power of the present patch is known
  double list_motion = 0;

  std::vector<double> y;
  std::vector<StateField> fields;
  std::vector<std::uint8_t> on_surface, in_state, extra, with_elastic;
  std::vector<Index> in_state_list, surface_list;
  Counters counters;
  EnergyBudget energy;
  MomentumBudget momentum;
  MassBudget mass;
};

}  // namespace meltray::scene
