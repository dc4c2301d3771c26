// SPDX-License-Identifier: MIT
#include "meltray/scene/elastic.hpp"
#include "scene/keys_build.hpp"

namespace meltray::scene {

Need elastic() {
  return {"flow.solid = \"elastic\"", {"flow.solid", "flow.solver", "model"}, [](const Scene& s, int) {
            return is_elastic(s);
          }};
}

std::vector<Key> elastic_keys() {
  const Need follows = {"heat.bulk_interval_s > 0", {"heat.bulk_interval_s"}, [](const Scene& s, int) {
                          return s.heat.bulk_interval > 0;
                        }};
  return {
      number("flow.elastic_modulus_scale", "", above_to(0, 1), MELTRAY_AT(flow.elastic_modulus_scale),
             "Factor on Young's modulus of elastic solid: steps grow with its inverse root, strains and "
             "displacements under load with its inverse, and stresses are not those of the material.")
          .only_if(elastic()),
      number("flow.elastic_viscosity", "", between(0, 2), MELTRAY_AT(flow.elastic_viscosity),
             "Coefficient alpha of the artificial viscosity of elastic solid, with its own speed of sound.")
          .only_if(elastic()),
      number("flow.elastic_artificial_stress", "", between(0, 1), MELTRAY_AT(flow.elastic_artificial_stress),
             "Artificial stress of elastic solid over its tensile stress: keeps particles from pairing.")
          .only_if(elastic()),
      number("flow.elastic_depth_m", "m", above(0), MELTRAY_AT(flow.elastic_depth),
             "Solid within this distance of the melt is elastic, the rest stays at its place.")
          .otherwise("reach of the kernel, two smoothing lengths",
                     [](Scene& s, int, const Document&) {
                       s.flow.elastic_depth = 2 * s.domain.smoothing_ratio * s.domain.spacing;
                     })
          .only_if(elastic())
          .only_if(follows),
  };
}

}  // namespace meltray::scene
