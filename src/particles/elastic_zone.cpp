// SPDX-License-Identifier: MIT
#include <algorithm>

#include "meltray/particles/patch.hpp"

/// Solid that moves: which it is, and the cells that it moves through.
namespace meltray {

void PatchSelector::mark_elastic(Particles& particles, Patch& patch, Index reach) {
  marked_.assign(grid_.cells(), core_.empty() ? 1 : 0);
  for (Index cell = 0; cell < static_cast<Index>(core_.size()); ++cell)
    if (core_[cell]) grid_.for_block(cell, reach, [&](Index k) { marked_[k] = 1; });

  const auto x = view(static_cast<const Particles&>(particles).x);
  for (Index i = 0; i < static_cast<Index>(particles.size()); ++i) {
    if (!particles.has(i, kMobile) || marked_[grid_.cell(x, i)]) continue;
    particles.flags[i] &= static_cast<std::uint8_t>(~kMobile);
    for (int c = 0; c < particles.dim; ++c) particles.v[c][i] = 0;
  }

  const auto rank = [](Elastic e) { return static_cast<std::uint8_t>(e); };
  patch.elastic.assign(patch.size(), rank(Elastic::none));
  for (Index cell = 0; cell < grid_.cells(); ++cell) {
    for (Index k = patch.cell_start[cell]; k < patch.cell_start[cell + 1]; ++k) {
      const Index i = patch.global[k];
      if (patch.liquid[k] || patch.wall[k]) continue;
      if (!marked_[cell]) {
        for (int c = 0; c < patch.dim; ++c) patch.v[c][k] = 0;
      } else if (particles.has(i, kClamped)) {
        patch.elastic[k] = rank(Elastic::clamped);
      } else {
        patch.elastic[k] = rank(Elastic::free);
        particles.flags[i] |= kMobile;
      }
    }
  }
}

void PatchSelector::follow(const Particles& particles, const Patch& patch) {
  const auto before = view(particles.x), after = view(patch.x);
  for (Index k = 0; k < patch.size(); ++k) {
    if (patch.elastic[k] != static_cast<std::uint8_t>(Elastic::free)) continue;
    const Index i = patch.global[k], from = grid_.cell(before, i), to = grid_.cell(after, k);
    if (from == to) continue;
    auto &left = resting_[from], &entered = resting_[to];
    left.erase(std::lower_bound(left.begin(), left.end(), i));
    entered.insert(std::lower_bound(entered.begin(), entered.end(), i), i);
  }
}

}  // namespace meltray
