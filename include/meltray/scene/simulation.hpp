// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "meltray/core/archive.hpp"
#include "meltray/core/timers.hpp"
#include "meltray/laser/laser.hpp"
#include "meltray/particles/particles.hpp"
#include "meltray/scene/scene.hpp"

namespace meltray::scene {

/// Energy since t = 0 [J], each item accumulated where it happens. Closes when
/// stored - initial = laser + boundary - evaporation - radiation - ejected - cropped (relative to the
/// largest).
struct EnergyBudget {
  double initial = 0, stored = 0;  ///< enthalpy of all particles still in the scene
  double laser = 0;                ///< absorbed by particles
  double boundary = 0;             ///< through faces with temperature or flux
  double evaporation = 0, radiation = 0;
  double ejected = 0;      ///< enthalpy of particles that left through a free face
  double cropped = 0;      ///< the same through a wall, where the workpiece was cropped
  double undeposited = 0;  ///< laser power that found no particle (counted, not part of `laser`)
  double relative_error() const;
};

/// Momentum of liquid particles and the impulses that changed it [kg m/s]:
/// current - initial = gravity + surface + pressure + viscosity + shifting + phase_change - ejected.
/// `pressure` holds the surface force of recoil and tension as well, `surface` the Marangoni stress.
struct MomentumBudget {
  Vec3 initial = Vec3::Zero(), current = Vec3::Zero();
  Vec3 gravity = Vec3::Zero(), surface = Vec3::Zero(), pressure = Vec3::Zero(), viscosity = Vec3::Zero();
  Vec3 shifting = Vec3::Zero();  ///< of the convective correction of the shifted velocity
  Vec3 phase_change = Vec3::Zero(), ejected = Vec3::Zero();
};

struct MassBudget {
  double initial = 0, current = 0, ejected = 0, cropped = 0;
  double evaporated_not_removed = 0;  ///< what evaporation would have taken: reported, not removed
};

/// Laser energy since t = 0 [J]: in = absorbed + escaped + residual + dropped. `worst` is the largest
/// relative error of any single trace.
struct LaserBudget {
  double in = 0, absorbed = 0, escaped = 0, residual = 0, dropped = 0, worst = 0;
  std::int64_t traces = 0, rays = 0, dropped_rays = 0;
};

struct Counters {
  std::int64_t steps = 0, rejected = 0, explicit_evals = 0, implicit_evals = 0, linear_solves = 0;
  std::int64_t pressure_solves = 0, pressure_iterations = 0, pressure_at_limit = 0;
  std::int64_t heat_iterations = 0, viscous_iterations = 0, list_builds = 0;
  std::int64_t liquid_particle_steps = 0, clamped = 0, removed = 0, ejected = 0;
  std::map<std::string, std::int64_t> limiter;  ///< steps by what set their length
};

/// How far the density of a weakly compressible melt is from rho_0(T): 99 of 100 liquid particles are nearer
/// than this share of it. Zero in incompressible scenes.
struct DensityVariation {
  double now = 0;
  double largest = 0;                       ///< since t = 0, looked at every ten steps
  static constexpr double kAllowed = 0.03;  ///< beyond it the flow is no longer nearly incompressible
};

/// What the laser did at the last trace [W].
struct LaserState {
  double power = 0, absorbed = 0, escaped = 0, residual = 0;
};

struct StepInfo {
  double t = 0, dt = 0;
  std::string limiter;
};

/// One line for `meltray check` and the log: a term, whether it is active, and where it is integrated.
struct TermInfo {
  std::string name;
  bool active = false;
  std::string partition;  ///< "explicit", "implicit", "projected", "between steps", or why it is skipped
};

/// A scene assembled into particles and terms, advanced in time.
class Simulation {
 public:
  explicit Simulation(Scene scene);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  const Scene& scene() const;
  double time() const;
  /// One accepted step that does not pass t_stop, and all that happens between steps.
  /// Throws NumericalFailure with a diagnosis; the state is then that of the last accepted step, or that of
  /// the new one before the projection that failed: both can be saved and gone on from.
  StepInfo step(double t_stop);

  const Particles& particles() const;
  Particles& particles();  ///< for initial conditions set in code, before the first step
  /// 1 where the particle is on the free surface (particles that were not looked at: 0).
  const std::vector<std::uint8_t>& on_surface() const;
  EnergyBudget energy() const;
  MomentumBudget momentum() const;
  MassBudget mass() const;
  LaserBudget laser_budget() const;
  LaserState laser_state() const;
  /// Surface mesh of the last trace; null without a laser.
  const laser::Tracer* tracer() const;
  const laser::Beam* beam() const;
  Counters counters() const;
  DensityVariation density_variation() const;
  Timers& timers();
  double evaporative_loss() const;  ///< [W] at the last step
  std::size_t liquid_count() const;
  std::size_t active_count() const;  ///< particles that flow or exchange heat, without elastic solid
  std::vector<TermInfo> terms() const;
  /// Every step limit of the current state: name -> seconds (before error control).
  std::vector<StepLimit> step_limits();
  /// Bytes held, by part; those of terms and of the integrator before the first step are what it is going to
  /// take.
  std::vector<std::pair<std::string, std::size_t>> memory() const;

  /// Saves or loads the whole state. Saving drops everything that carries history (lists, warm starts,
  /// trees), so that a run that goes on and one that resumes take the same path bit for bit.
  void archive(Archive& a);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meltray::scene
