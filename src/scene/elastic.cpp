// SPDX-License-Identifier: MIT
#include "meltray/scene/elastic.hpp"

namespace meltray::scene {

bool is_elastic(const Scene& scene) {
  return scene.terms.pressure && scene.flow.solver == FlowSolver::wcsph &&
         scene.flow.solid == SolidModel::elastic;
}

terms::ElasticSolid elastic_solid(const Scene& scene) {
  const Flow& flow = scene.flow;
  const Material& m = scene.material;
  const double e = flow.elastic_modulus_scale * m.youngs_modulus, nu = m.poisson_ratio;
  terms::ElasticSolid solid;
  solid.bulk_modulus = e / (3 * (1 - 2 * nu));
  solid.shear_modulus = e / (2 * (1 + nu));
  solid.expansion = flow.thermal_expansion ? m.linear_expansion_solid : 0.0;
  solid.viscosity = flow.elastic_viscosity;
  solid.artificial_stress = flow.elastic_artificial_stress;
  solid.melt_drag = scene.terms.artificial_viscosity ? flow.artificial_viscosity * flow.sound_speed : 0.0;
  solid.gravity = scene.terms.gravity ? scene.domain.gravity : 0.0;
  return solid;
}

}  // namespace meltray::scene
