// SPDX-License-Identifier: MIT
#include <cmath>

#include "scene/model.hpp"

/// The weakly compressible flow of a Model: density is a field of the state and all forces are explicit.
namespace meltray::scene {

namespace {

terms::Tension tension_of(Tension t) {
  switch (t) {
    case Tension::full:
      return terms::Tension::full;
    case Tension::none:
      return terms::Tension::none;
    case Tension::artificial_stress:
      return terms::Tension::artificial_stress;
  }
  return terms::Tension::full;
}

}  // namespace

WeaklyCompressible::WeaklyCompressible(const Scene& scene) {
  const Flow& flow = scene.flow;
  const double c = flow.sound_speed;
  const terms::Tension tension = tension_of(flow.tension);
  state = {c, flow.thermal_expansion, tension, scene.terms.gravity ? scene.domain.gravity : 0.0};
  continuity = {c};
  force = {flow.pressure_gradient == PressureGradient::sum ? terms::GradientForm::sum
                                                           : terms::GradientForm::difference,
           tension};
  diffusion.sound_speed = c;
  diffusion.coefficient = flow.density_diffusion == DensityDiffusion::none ? 0.0 : flow.diffusion_coefficient;
  diffusion.form = flow.density_diffusion == DensityDiffusion::antuono
                       ? terms::DiffusionForm::antuono
                       : terms::DiffusionForm::molteni_colagrossi;
  artificial.alpha = scene.terms.artificial_viscosity ? flow.artificial_viscosity : 0.0;
  artificial.sound_speed = c;
}

void Model::add_pressure_rates(terms::Rates& rates, terms::Crossings& crossings) {
  const auto timer = timers_.measure(Part::pressure);
  const WeaklyCompressible& w = *weak_;
  density_rate_.assign(stage.size(), 0.0);
  rates.density = density_rate_.data();
  w.continuity.add_rate(stage, rates.density);
  if (w.diffusion.coefficient > 0) w.diffusion.add_rate(stage, rates.density);
  w.force.add_acceleration(stage, rates.acceleration);
  w.force.add_surface_force(stage, rates.acceleration);
  crossings.pressure = force_gained();
  if (w.artificial.alpha > 0) {
    w.artificial.add_acceleration(stage, rates.acceleration);
    crossings.viscosity += force_gained();
  }
  if (has_elastic_solid()) add_elastic_rates(rates);
  note_largest_acceleration();
}

double Model::acoustic_step(double speed) const {
  // The factor on alpha is the viscous part of the limit, Monaghan 1989.
  const double c = scene_.flow.sound_speed * (1 + 0.6 * weak_->artificial.alpha);
  return scene_.time.cfl_acoustic * constants_.smoothing / (c + speed);
}

double Model::density_on_melting(Index i) const {
  const double c = scene_.flow.sound_speed;
  return weak_->state.reference_density(constants_, stage.temperature[i]) + patch.pressure[i] / (c * c);
}

}  // namespace meltray::scene
