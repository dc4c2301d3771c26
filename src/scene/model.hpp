// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "meltray/core/timers.hpp"
#include "meltray/scene/elastic.hpp"
#include "meltray/scene/scene.hpp"
#include "meltray/scene/simulation.hpp"
#include "meltray/terms/conduction.hpp"
#include "meltray/terms/evaporation.hpp"
#include "meltray/terms/least_distance.hpp"
#include "meltray/terms/pressure/acoustic_pass.hpp"
#include "meltray/terms/pressure/projection.hpp"
#include "meltray/terms/shifting.hpp"
#include "meltray/terms/stage.hpp"
#include "meltray/terms/surface_forces.hpp"
#include "meltray/terms/viscosity.hpp"
#include "meltray/time/integrator.hpp"

namespace meltray::scene {

/// Where each term that can be implicit is integrated at present; "auto" terms move with their stiffness.
struct Partitions {
  bool conduction = false, viscosity = false, interface_viscosity = false,
       losses = false;  ///< true = implicit
  bool operator==(const Partitions&) const = default;
};

/// True for methods with an explicit and an implicit side that terms can choose between.
inline bool has_two_sides(Method m) {
  return m == Method::imex || m == Method::euler;
}

/// The terms of a weakly compressible scene.
terms::AcousticPass acoustic_pass(const Scene& scene);

/// The active terms of a scene as an ODE on the patch: y = [x | v | rho | h | x v rho S | crossings] of the
/// particles that move, those that exchange heat, and elastic solid, rho only in weakly compressible scenes;
/// f_E and f_I are sums over the terms of each partition.
class Model : public OdeProblem {
 public:
  Model(const Scene& scene, const terms::SceneConstants& constants, Timers& timers);

  /// False in scenes whose sums over pairs are all made by the acoustic pass: they have no list of pairs, and
  /// no surface besides.
  bool needs_pairs() const;
  /// Gives back the memory of lists and patch, which have to be made anew for the next step.
  void release();
  /// The pairs of a patch that has been selected anew and whose stage is prepared: `skin` [m] as in the list,
  /// periods of the box [m].
  void find_pairs(double skin, const std::array<double, 3>& period);
  /// Geometry, temperatures and surface of the patch as it is; where it `rests`, geometry and surface are
  /// those of the last call. The stage must have been prepared for it.
  void evaluate_patch(double t, bool rests = false);
  /// Temperatures of the faces, and what rests on them, once light has been brought to the evaluated patch;
  /// nothing in scenes that go by the temperature of the particles.
  void settle_faces();
  /// Copies the evaluated patch into y and describes its fields.
  void pack(std::vector<double>& y, std::vector<StateField>& fields);
  /// Copies y into the patch and makes geometry, temperatures and surface those of y.
  void evaluate(double t, const double* y);
  /// Copies y into the patch, no more: the end of a step whose geometry the next one evaluates.
  void unpack(const double* y);
  /// Where density is a field of the state, makes the pressures those of the densities: the end of a step
  /// that is evaluated no more.
  void update_equation_of_state();
  /// Whether melt at the surface is kept from overlapping.
  bool keeps_apart() const;
  /// Parts melt that has come too close over the step dt [s]: moves positions of the patch, by what at most
  /// [m].
  double keep_apart(double dt);
  /// One projection over the step dt [s] that led to the evaluated patch: corrects its velocities, Eq. (6).
  void project(double dt);
  /// Accelerations of one patch particle by term, largest first, at the evaluated state: "pressure 3e+06
  /// m/s^2, ...".
  std::string blame(Index i, double dt);
  /// The same for its heating: "conduction 3e+12 W/kg, ...".
  std::string blame_heat(Index i);
  /// Chooses the partition of "auto" terms from their stiffness against the step expected next, where the
  /// method has two sides; multirate methods have conduction on the slow side, which takes the place of the
  /// implicit one.
  void choose_partitions(double dt);
  /// Partitions of a run that goes on: those of before for what is "auto", in a method that has the choice.
  void take_up(const Partitions& before);

  bool has_explicit() const override;
  bool has_implicit() const override;
  bool implicit_is_linear() const override;
  void explicit_rate(double t, const double* y, double* rate) override;
  void implicit_rate(double t, const double* y, double* rate) override;
  bool solve_linear(double t, double gamma, const double* known, double* z) override;
  bool solve_implicit(double t, const double* y, double gamma, double* b) override;
  StepLimit stable_step(double t, const double* y) override;
  std::vector<StepLimit> step_limits();

  /// Where the crossings stand in y; after a step they hold its integrals [J, kg, N s].
  std::size_t crossings_begin() const;
  bool flows() const { return scene_.terms.pressure; }
  bool weakly_compressible() const { return acoustic_.has_value(); }
  std::size_t acoustic_bytes() const { return acoustic_ ? acoustic_->bytes() : 0; }
  /// Bytes of what the terms of a step hold besides, once all of them have been at work.
  std::size_t term_bytes() const;
  bool has_elastic_solid() const { return elastic_.has_value(); }
  /// One projection after each step, with all geometry frozen over the step.
  bool projects_steps() const {
    return flows() && !weakly_compressible() && scene_.flow.projection == Projection::step;
  }
  /// Density with which a resting particle of the patch joins the melt: it keeps its pressure [kg/m^3].
  double density_on_melting(Index i) const;
  /// Density of solid without pressure at a temperature: that of elastic solid, else the scene's [kg/m^3].
  double density_of_solid(double temperature) const;
  /// Largest speed of some particles of the patch, loose drops among them or not [m/s].
  double largest_speed(const std::vector<Index>& which, bool with_loose) const;

  terms::Stage stage;
  Patch patch;
  sph::PairList pairs;
  std::vector<double> laser_power;  ///< per patch particle [W]; empty without a laser
  Partitions partitions;
  double largest_acceleration = 0;  ///< of the last projection [m/s^2]
  double drift_time = 0;            ///< in which errors of density are taken back [s]
  double divergence_time = 0;       ///< in which the `stage` projection takes back errors of divergence [s]
  Counters* counters = nullptr;
  Vec3 pressure_impulse = Vec3::Zero();  ///< of the last step's projection [kg m/s]
  terms::Projection projection;

 private:
  terms::Rates cleared_rates();
  void update_temperature(Index i);
  void update_heated_temperatures();
  void update_surface();
  void forget_coefficients();
  void update_surface_pressure();
  bool adds_recoil_slope() const;
  void find_faces();
  void finish_rates(const double* y, double* rate, const terms::Crossings& crossings, bool transport);
  terms::ViscousOperator& viscous_operator(bool implicit_part);
  terms::ConductionOperator& conduction_operator();
  void add_viscous(bool implicit_part, const MutField& acceleration);
  void add_forces(terms::Rates& rates, bool implicit_part, terms::Crossings& crossings);
  bool solve_viscous(double gamma, const double* known, const Components& resting, double* v, Vec3& impulse);
  Vec3 total_force() const;
  Vec3 force_gained();
  void add_projected_pressure(const MutField& acceleration);
  void note_largest_acceleration();
  void add_heat(terms::Rates& rates, bool implicit_part, terms::Crossings& crossings);
  void pressure_in_stage(terms::Rates& rates, terms::Crossings& crossings);
  void count_solve(const solve::SolveReport& report, double t);
  terms::ViscousChoice viscous(bool implicit_part) const;
  bool needs_surface() const;
  bool holds_positions(const double* y) const;
  bool holds_enthalpies(const double* y) const;
  bool holds_rest(const double* y) const;
  std::size_t enthalpy_begin() const;
  void add_pressure_rates(terms::Rates& rates, terms::Crossings& crossings);
  bool keeps_along_surface() const;
  void add_frozen_along_surface(const MutField& acceleration);
  double acoustic_step(double speed) const;
  std::size_t elastic_begin() const;
  std::size_t elastic_size() const;
  void pack_elastic(std::vector<double>& y) const;
  void add_elastic_fields(std::vector<StateField>& fields) const;
  void unpack_elastic(const double* y);
  void add_elastic_rates(terms::Rates& rates);
  void finish_elastic_rates(const double* y, double* rate, bool transport) const;
  double elastic_step() const;

  const Scene& scene_;
  const terms::SceneConstants& constants_;
  Timers& timers_;

  terms::InterfaceViscosityParameters interface_;
  terms::ViscousOperator viscous_explicit_, viscous_implicit_;
  terms::ConductionOperator conduction_;
  terms::SurfaceLosses losses_;
  terms::SurfaceTension tension_;
  terms::Wetting wetting_;
  terms::Recoil recoil_;
  terms::Marangoni marangoni_;
  terms::Buoyancy buoyancy_;
  terms::Shifting shifting_;
  terms::LeastDistance least_distance_;
  terms::ProjectionOptions projection_options_;
  std::optional<terms::AcousticPass> acoustic_;  ///< of weakly compressible scenes
  std::optional<terms::ElasticSolid> elastic_;

  Components acceleration_, transport_, all_forces_,
      along_surface_;  ///< scratch, one entry per patch particle
  SymmetricComponents stress_rate_;
  std::vector<double> heating_, density_rate_, surface_pressure_, recoil_pressure_, recoil_average_,
      loss_slope_, source_, other_;
  Vec3 counted_force_ = Vec3::Zero();  ///< total force at the last force_gained() of a rate [N]
  Components solve_b_, solve_x_, at_rest_;
  std::vector<double> guess_, solve_h_b_, solve_h_x_;
  const double* packed_ = nullptr;  ///< the state that the patch holds, if it is that of the last pack()
  bool implicit_viscous_valid_ = false, explicit_viscous_valid_ = false, conduction_valid_ = false,
       along_surface_valid_ = false;
};

}  // namespace meltray::scene
