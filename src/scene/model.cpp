// SPDX-License-Identifier: MIT
#include "scene/model.hpp"

#include "meltray/core/memory.hpp"
#include "meltray/scene/expected_flow.hpp"

namespace meltray::scene {

namespace {

/// Time constants of the projections' corrections and of the parting of what has come too close, in times
/// that the flow takes to cross a spacing.
constexpr double kDriftCrossings = 7, kDivergenceCrossings = 0.2, kPartingCrossings = 0.2;

/// What the case file says, as far as the method leaves a choice; "auto" starts explicit.
Partitions initial_partitions(const Time& time) {
  const Method method = time.integrator.method;
  if (!has_two_sides(method)) {
    const bool all = method == Method::implicit_rk;
    return {all || method == Method::multirate, all, all, all};
  }
  const auto implicit = [](PartitionChoice c) { return c == PartitionChoice::implicit_; };
  return {implicit(time.conduction), implicit(time.viscosity), implicit(time.interface_viscosity),
          implicit(time.evaporation)};
}

}  // namespace

Model::Model(const Scene& scene, const terms::SceneConstants& constants, Timers& timers)
    : scene_(scene), constants_(constants), timers_(timers) {
  const Flow& flow = scene.flow;
  interface_ = {flow.interface_viscosity_free, flow.interface_viscosity_solid, flow.reference_speed,
                flow.interface_viscosity_ramp};
  losses_ = {scene.terms.evaporation, scene.terms.radiation, scene.surface.evaporation_coefficient,
             scene.surface.ambient_temperature, scene.surface.temperature == SurfaceTemperature::face};
  tension_.ramp = scene.surface.activation_ramp;
  wetting_.contact_angle_deg = scene.material.contact_angle_deg;
  recoil_ = {scene.surface.recoil_onset, scene.surface.recoil_coefficient, scene.surface.recoil_pressure,
             scene.surface.recoil_ramp, scene.surface.recoil_radius};
  buoyancy_ = {scene.weighs(), scene.terms.buoyancy, scene.domain.gravity};
  shifting_ = {flow.shifting, flow.shifting_speed};
  projection_options_ = {scene.surface.entry, flow.pressure_solver, flow.pressure_tolerance,
                         flow.pressure_max_iterations};
  const double crossing = constants.spacing / expected_speed(scene);
  drift_time = flow.drift_time > 0 ? flow.drift_time : kDriftCrossings * crossing;
  least_distance_ = {flow.least_distance, kPartingCrossings * crossing};
  divergence_time = kDivergenceCrossings * crossing;
  partitions = initial_partitions(scene.time);
  if (scene.terms.pressure && flow.solver == FlowSolver::wcsph) acoustic_ = acoustic_pass(scene);
  if (is_elastic(scene)) elastic_ = elastic_solid(scene);
  stage.constants = &constants_;
  stage.patch = &patch;
  stage.pairs = &pairs;
}

void Model::take_up(const Partitions& before) {
  partitions = initial_partitions(scene_.time);
  if (!has_two_sides(scene_.time.integrator.method)) return;
  const auto keep = [](PartitionChoice choice, bool was, bool& part) {
    if (choice == PartitionChoice::automatic) part = was;
  };
  const Time& time = scene_.time;
  keep(time.conduction, before.conduction, partitions.conduction);
  keep(time.viscosity, before.viscosity, partitions.viscosity);
  keep(time.interface_viscosity, before.interface_viscosity, partitions.interface_viscosity);
  keep(time.evaporation, before.losses, partitions.losses);
}

bool Model::needs_surface() const {
  const Terms& t = scene_.terms;
  return needs_pairs() && (t.pressure || t.surface_tension || t.recoil || t.evaporation || t.radiation ||
                           t.marangoni || scene_.laser.has_value());
}

terms::ViscousChoice Model::viscous(bool implicit_part) const {
  return {scene_.terms.viscosity && partitions.viscosity == implicit_part,
          scene_.terms.interface_viscosity && partitions.interface_viscosity == implicit_part};
}

bool Model::has_explicit() const {
  const Terms& t = scene_.terms;
  return flows() || scene_.laser.has_value() || (t.conduction && !partitions.conduction) ||
         ((t.evaporation || t.radiation) && !partitions.losses);
}

bool Model::has_implicit() const {
  return viscous(true).any() || (scene_.terms.conduction && partitions.conduction) ||
         ((scene_.terms.evaporation || scene_.terms.radiation) && partitions.losses);
}

bool Model::implicit_is_linear() const {
  // Viscosity alone: its coefficients rest on positions and temperatures that no implicit term changes.
  return !(scene_.terms.conduction && partitions.conduction) &&
         !((scene_.terms.evaporation || scene_.terms.radiation) && partitions.losses);
}

void Model::release() {
  pairs = {};
  patch = {};
  viscous_explicit_ = viscous_implicit_ = {};
  conduction_ = {};
  projection = {};
  free_memory(acceleration_, transport_, all_forces_, along_surface_, solve_b_, solve_x_, at_rest_,
              stress_rate_);
  free_memory(heating_, density_rate_, surface_pressure_, recoil_pressure_, recoil_average_, loss_slope_,
              source_, other_, guess_, solve_h_b_, solve_h_x_);
  if (acoustic_) acoustic_->release();
  terms::release_fields(stage);
}

std::size_t Model::term_bytes() const {
  const Terms& t = scene_.terms;
  const std::size_t dim = constants_.dim, particles = stage.size();
  const bool projected = flows() && !weakly_compressible(), viscous = t.viscosity || t.interface_viscosity;
  // Coefficients of pairs: of the viscosities, of conduction, of the Poisson matrix with its columns.
  const std::size_t of_pair =
      sizeof(float) * ((t.viscosity ? 1 : 0) + (t.interface_viscosity ? 1 : 0) + (t.conduction ? 1 : 0)) +
      (projected ? sizeof(float) + sizeof(Index) : 0);
  // Fields: rates, and of each linear system its diagonal, the solver's vectors, right-hand side and
  // solution.
  const std::size_t of_surface = (t.surface_tension || t.recoil ? 1 : 0) + (t.recoil ? 1 : 0) +
                                 (adds_recoil_slope() ? 1 : 0) + (keeps_along_surface() ? dim : 0);
  const std::size_t of_particle = (flows() ? dim : 0) + of_surface + (weakly_compressible() ? 1 : 0) +
                                  (shifting_.coefficient > 0 ? dim : 0) + (viscous ? 5 * dim + 5 : 0) +
                                  (stage.heated.empty() ? 0 : 1) + (t.conduction ? 11 : 0) +
                                  (projected ? 12 : 0);
  return pairs.slots() * of_pair + particles * of_particle * sizeof(double);
}

void Model::evaluate_patch(double t, bool rests) {
  stage.t = t;
  if (needs_pairs() && !rests) {
    const auto timer = timers_.measure(Part::neighbours);
    pairs.refresh(patch, constants_.kernel);
  }
  parallel_for(stage.size(), [&](Index i) { update_temperature(i); });
  stage.face_temperature.clear();
  if (weakly_compressible()) acoustic_->state.update(stage);
  if (has_elastic_solid()) elastic_->update(stage);
  if (rests)
    forget_coefficients();
  else
    update_surface();
}

void Model::settle_faces() {
  find_faces();
  if (losses_.at_face && weakly_compressible()) update_surface_pressure();
}

void Model::find_faces() {
  if (!losses_.at_face) return;
  const auto timer = timers_.measure(Part::heat);
  losses_.find_faces(stage, laser_power);
}

void Model::update_temperature(Index i) {
  stage.temperature[i] = constants_.material.temperature(patch.h[i]);
}

void Model::update_heated_temperatures() {
  parallel_for(static_cast<std::ptrdiff_t>(stage.heated.size()),
               [&](std::ptrdiff_t k) { update_temperature(stage.heated[k]); });
}

/// Surface, and the coefficients that rest on it.
void Model::update_surface() {
  if (needs_surface()) {
    const auto timer = timers_.measure(Part::surface);
    terms::compute_surface(stage);
    if (scene_.terms.wetting) wetting_.turn_normals(stage);
  }
  if (weakly_compressible()) {
    const auto timer = timers_.measure(Part::pressure);
    acoustic_->gather(stage);
    if (!losses_.at_face) update_surface_pressure();  // else once the faces are known
  }
  forget_coefficients();
}

void Model::forget_coefficients() {
  implicit_viscous_valid_ = explicit_viscous_valid_ = conduction_valid_ = along_surface_valid_ = false;
}

void Model::evaluate(double t, const double* y) {
  const bool same = y == packed_, still = same || holds_positions(y), same_h = same || holds_enthalpies(y);
  if (still && same_h && (same || holds_rest(y)) && t == stage.t) return;
  stage.t = t;
  unpack(y);
  if (!same_h) {
    update_heated_temperatures();
    find_faces();
  }

  // With one projection a step the scheme is first order in the geometry anyway: pairs, surface and the
  // coefficients that rest on them are those of the start of the step. A weakly compressible step is so short
  // that only what travels with sound is renewed in its stages.
  if (weakly_compressible()) {
    if (!still && has_elastic_solid()) {
      const auto timer = timers_.measure(Part::neighbours);
      pairs.refresh(patch, constants_.kernel, stage.elastic);
    }
    acoustic_->state.update(stage);
    if (has_elastic_solid()) elastic_->update(stage);
    const auto timer = timers_.measure(Part::pressure);
    acoustic_->gather(stage);
  } else if (!projects_steps()) {
    if (!still) {
      const auto timer = timers_.measure(Part::neighbours);
      pairs.refresh(patch, constants_.kernel);
      update_surface();
    } else if (!same_h) {
      implicit_viscous_valid_ = explicit_viscous_valid_ = conduction_valid_ = false;
    }
  }
}

/// The renormalised gradient of the other entry is whole at the surface.
bool Model::adds_recoil_slope() const {
  return scene_.terms.recoil && projection_options_.entry == terms::SurfaceEntry::csf;
}

/// sigma kappa + recoil at the surface, averaged over surface neighbours; only the pressure needs it.
void Model::update_surface_pressure() {
  const Terms& terms = scene_.terms;
  if (!terms.surface_tension && !terms.recoil) return;
  const auto timer = timers_.measure(Part::surface);
  if (terms.surface_tension)
    tension_.pressure(stage, surface_pressure_);
  else
    surface_pressure_.assign(stage.size(), 0.0);
  if (terms.recoil) {
    recoil_pressure_.resize(stage.size());
    parallel_for(stage.size(), [&](Index i) {
      recoil_pressure_[i] = 0;
      if (!patch.liquid[i] || stage.surface[i] == 0) return;
      const double x = patch.x[0][i], y = constants_.dim == 3 ? patch.x[1][i] : 0;
      recoil_pressure_[i] =
          recoil_.pressure(constants_.material, stage.surface_temperature(i), stage.t, x * x + y * y);
      surface_pressure_[i] += recoil_pressure_[i];
    });
    if (adds_recoil_slope()) terms::average_over_surface(stage, recoil_pressure_, recoil_average_);
  }
  terms::average_over_surface(stage, surface_pressure_, stage.surface_pressure);
}

terms::Rates Model::cleared_rates() {
  const Index n = stage.size();
  for (int c = 0; c < constants_.dim; ++c) clear(acceleration_[c], n);
  clear(heating_, stage.heated.empty() ? 0 : n);
  counted_force_ = Vec3::Zero();
  return {view(acceleration_), heating_.data()};
}

/// Sum of m a over the moving particles for the accelerations gathered so far [N].
Vec3 Model::total_force() const {
  const int dim = constants_.dim;
  return parallel_reduce(
      static_cast<std::ptrdiff_t>(stage.moving.size()), Vec3(Vec3::Zero()),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Vec3 sum = Vec3::Zero();
        for (std::ptrdiff_t k = begin; k < end; ++k) {
          const Index i = stage.moving[k];
          for (int c = 0; c < dim; ++c) sum[c] += patch.mass[i] * acceleration_[c][i];
        }
        return sum;
      },
      [](const Vec3& a, const Vec3& b) { return Vec3(a + b); }, kRows);
}

/// What has been added to the total force since the last call [N].
Vec3 Model::force_gained() {
  const Vec3 before = counted_force_;
  counted_force_ = total_force();
  return counted_force_ - before;
}

/// The operator of one side, assembled for the present stage.
terms::ViscousOperator& Model::viscous_operator(bool implicit_part) {
  auto& op = implicit_part ? viscous_implicit_ : viscous_explicit_;
  bool& valid = implicit_part ? implicit_viscous_valid_ : explicit_viscous_valid_;
  if (!valid) op.assemble(stage, viscous(implicit_part), interface_);
  valid = true;
  return op;
}

/// The same of conduction.
terms::ConductionOperator& Model::conduction_operator() {
  if (!conduction_valid_) conduction_.assemble(stage);
  conduction_valid_ = true;
  return conduction_;
}

void Model::add_viscous(bool implicit_part, const MutField& acceleration) {
  const auto timer = timers_.measure(Part::viscosity);
  viscous_operator(implicit_part)
      .add_acceleration(stage, view(static_cast<const Patch&>(patch).v), acceleration);
}

/// Where the surface stands still within a step, so do the forces along it. (That of a projected pressure
/// comes with the projection.)
bool Model::keeps_along_surface() const {
  return (weakly_compressible() && (scene_.terms.marangoni || adds_recoil_slope())) ||
         (projects_steps() && scene_.terms.marangoni);
}

void Model::add_frozen_along_surface(const MutField& acceleration) {
  if (!along_surface_valid_) {
    for (int c = 0; c < constants_.dim; ++c) clear(along_surface_[c], stage.size());
    if (scene_.terms.marangoni) marangoni_.add_acceleration(stage, view(along_surface_));
    if (weakly_compressible() && adds_recoil_slope())
      terms::add_recoil_along_surface(stage, recoil_average_, view(along_surface_));
    along_surface_valid_ = true;
  }
  for (int c = 0; c < constants_.dim; ++c)
    parallel_for(static_cast<std::ptrdiff_t>(stage.moving.size()), [&](std::ptrdiff_t k) {
      const Index i = stage.moving[k];
      acceleration[c][i] += along_surface_[c][i];
    });
}

void Model::add_forces(terms::Rates& rates, bool implicit_part, terms::Crossings& crossings) {
  if (viscous(implicit_part).any()) {
    add_viscous(implicit_part, rates.acceleration);
    crossings.viscosity = force_gained();
  }
  if (implicit_part) return;
  const auto timer = timers_.measure(Part::forces);
  if (scene_.weighs() || scene_.terms.buoyancy) {
    buoyancy_.add_acceleration(stage, rates.acceleration);
    crossings.gravity = force_gained();
  }
  if (keeps_along_surface())
    add_frozen_along_surface(rates.acceleration);
  else if (scene_.terms.marangoni)
    marangoni_.add_acceleration(stage, rates.acceleration);
  else
    return;
  crossings.surface = force_gained();
}

void Model::add_heat(terms::Rates& rates, bool implicit_part, terms::Crossings& crossings) {
  const auto timer = timers_.measure(Part::heat);
  if (scene_.terms.conduction && partitions.conduction == implicit_part) {
    crossings.boundary += conduction_operator().add_heating(stage, rates.heating);
  }
  if ((scene_.terms.evaporation || scene_.terms.radiation) && partitions.losses == implicit_part)
    losses_.add_heating(stage, rates.heating, crossings);
  if (!implicit_part && !laser_power.empty()) {
    parallel_for(static_cast<std::ptrdiff_t>(stage.heated.size()), [&](std::ptrdiff_t k) {
      const Index i = stage.heated[k];
      rates.heating[i] += laser_power[i] / patch.mass[i];
    });
    crossings.laser += parallel_sum(static_cast<std::ptrdiff_t>(stage.heated.size()),
                                    [&](std::ptrdiff_t k) { return laser_power[stage.heated[k]]; });
  }
}

void Model::explicit_rate(double t, const double* y, double* rate) {
  evaluate(t, y);
  terms::Rates rates = cleared_rates();
  terms::Crossings crossings;
  if (flows()) {
    add_forces(rates, false, crossings);
    if (shifting_.coefficient > 0) {
      const auto timer = timers_.measure(Part::forces);
      for (int c = 0; c < constants_.dim; ++c) clear(transport_[c], stage.size());
      shifting_.add_rates(stage, view(transport_), rates.acceleration);
      crossings.shifting = force_gained();
    }
    if (weakly_compressible())
      add_pressure_rates(rates, crossings);
    else if (!projects_steps())
      pressure_in_stage(rates, crossings);
  }
  add_heat(rates, false, crossings);
  finish_rates(y, rate, crossings, true);
}

}  // namespace meltray::scene
