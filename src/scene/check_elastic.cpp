// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "meltray/scene/elastic.hpp"
#include "scene/case_check.hpp"

namespace meltray::scene {

void check_elastic(const Scene& scene, const Document& document) {
  if (!scene.terms.pressure || scene.flow.solid != SolidModel::elastic) return;
  if (!is_elastic(scene))
    refuse(document.place("flow.solid"), "flow.solid",
           "\"elastic\" with flow.solver = \"isph\", whose solid rests",
           "\"fixed\", or flow.solver = \"wcsph\" with it");
  const Material& m = scene.material;
  if (m.youngs_modulus == 0)
    refuse(document.place("flow.solid"), "flow.solid",
           fmt::format("\"elastic\", and material \"{}\" has no Young's modulus", m.name),
           "\"fixed\", or material.youngs_modulus_pa and material.poisson_ratio with it");
  if (m.poisson_ratio <= -1 || m.poisson_ratio >= 0.5)
    refuse(document.place("material.poisson_ratio"), "material.poisson_ratio",
           fmt::format("{} with flow.solid = \"elastic\": a modulus is infinite", m.poisson_ratio),
           "more than -1 and less than 0.5");
}

}  // namespace meltray::scene
