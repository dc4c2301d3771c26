// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "meltray/scene/case_file.hpp"
#include "meltray/scene/simulation.hpp"

namespace meltray::app::studies {

/// One way to integrate a scene in time.
struct Variant {
  std::string name;   ///< "imex 2, conduction implicit, stage"
  std::string model;  ///< variants of one model tend to one solution as the step goes to zero
  scene::Overrides overrides;
};

/// Whether the pressure of the scene is projected (ISPH).
bool projects(const scene::Scene& scene);

/// Methods and orders that make sense for the scene, with every stiff term on the implicit side where there
/// is one; each projection where there is a pressure. `few`: the orders 2 and, of the additive pairs, 4.
std::vector<Variant> method_variants(const scene::Scene& scene, bool few);

/// Every assignment of the scene's stiff terms to the explicit and the implicit side of the additive pair of
/// order 2, with each projection, and conduction on the slow side of a multirate method.
std::vector<Variant> splitting_variants(const scene::Scene& scene);

/// Assignments that `auto` chooses, as splitting_variants() calls them, from the partitions of a run.
std::string assignment_of(const std::vector<scene::TermInfo>& terms);

/// time.fixed_step_s = step.
scene::Overrides fixed_step(double step);
/// Tolerances of the error control, all times `factor`.
scene::Overrides tolerances(const scene::Scene& scene, double factor);

/// A variant that is accurate for its size of step, by which references of `model` are computed.
Variant reference_variant(const scene::Scene& scene, const std::string& model);

scene::Overrides joined(scene::Overrides a, const scene::Overrides& b);

}  // namespace meltray::app::studies
