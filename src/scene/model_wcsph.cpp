// SPDX-License-Identifier: MIT
#include "scene/model.hpp"

/// The weakly compressible flow of a Model: density is a field of the state and all forces are explicit.
namespace meltray::scene {

terms::AcousticPass acoustic_pass(const Scene& scene) {
  const Flow& flow = scene.flow;
  terms::AcousticPass pass;
  pass.state = {flow.sound_speed, flow.thermal_expansion, flow.tension,
                scene.terms.gravity ? scene.domain.gravity : 0.0};
  if (flow.density_diffusion != DensityDiffusion::none)
    pass.diffusion.coefficient = flow.diffusion_coefficient;
  pass.diffusion.form = flow.density_diffusion == DensityDiffusion::antuono
                            ? terms::DiffusionForm::antuono
                            : terms::DiffusionForm::molteni_colagrossi;
  pass.force.form = flow.pressure_gradient;
  if (scene.terms.artificial_viscosity) pass.artificial.alpha = flow.artificial_viscosity;
  terms::AcousticPass::instructions();  // a wrong MELTRAY_INSTRUCTIONS is refused at the start
  return pass;
}

bool Model::needs_pairs() const {
  const Terms& t = scene_.terms;
  return !weakly_compressible() || acoustic_->force.form == terms::GradientForm::difference || t.viscosity ||
         t.interface_viscosity || t.surface_tension || t.wetting || t.marangoni || t.recoil ||
         scene_.exchanges_heat() || shifting_.coefficient > 0 || has_elastic_solid();
}

void Model::find_pairs(double skin, const std::array<double, 3>& period) {
  if (acoustic_) acoustic_->find_pairs(stage, skin, period);
}

void Model::update_equation_of_state() {
  if (!weakly_compressible()) return;
  if (scene_.flow.thermal_expansion) update_heated_temperatures();
  acoustic_->state.update(stage);
}

void Model::add_pressure_rates(terms::Rates& rates, terms::Crossings& crossings) {
  const auto timer = timers_.measure(Part::pressure);
  clear(density_rate_, stage.size());
  rates.density = density_rate_.data();
  acoustic_->evaluate(stage);
  acoustic_->add_rates(stage, rates.density, rates.acceleration);
  if (needs_surface()) acoustic_->force.add_surface_force(stage, rates.acceleration);
  crossings.pressure = force_gained();
  if (has_elastic_solid()) add_elastic_rates(rates);
  note_largest_acceleration();
}

double Model::acoustic_step(double speed) const {
  // The factor on alpha is the viscous part of the limit, Monaghan 1989.
  const double c = scene_.flow.sound_speed * (1 + 0.6 * acoustic_->artificial.alpha);
  return scene_.time.cfl_acoustic * constants_.smoothing / (c + speed);
}

double Model::density_on_melting(Index i) const {
  const double c = scene_.flow.sound_speed;
  return acoustic_->state.reference_density(constants_, stage.temperature[i]) + patch.pressure[i] / (c * c);
}

}  // namespace meltray::scene
