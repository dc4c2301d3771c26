// SPDX-License-Identifier: MIT
#include <algorithm>

#include "scene/simulation_impl.hpp"

/// What the steps of a simulation do besides where its solid is elastic.
namespace meltray::scene {

/// Cells of the patch around those with melt: two, or one more than elastic solid reaches.
Index Simulation::Impl::patch_reach() const {
  if (!model.has_elastic_solid()) return 2;
  return std::max<Index>(2, 1 + selector.cells_across(scene.flow.elastic_depth));
}

/// Rows of the pair list besides those of the melt: particles that exchange heat, and elastic solid.
const std::vector<std::uint8_t>& Simulation::Impl::list_rows() {
  if (!model.has_elastic_solid()) return extra;
  with_elastic = extra;
  for (Index i = 0; i < model.patch.size(); ++i)
    if (model.patch.elastic[i]) with_elastic[i] = 1;
  return with_elastic;
}

/// A particle has melted: its stress is gone, and its momentum is the melt's.
void Simulation::Impl::release(Index g) {
  particles.flags[g] &= static_cast<std::uint8_t>(~(kMobile | kClamped));
  for (int c = 0; c < symmetric_count(constants.dim); ++c) particles.stress[c][g] = 0;
  for (int c = 0; c < constants.dim; ++c) momentum.phase_change[c] += particles.mass[g] * particles.v[c][g];
}

}  // namespace meltray::scene
