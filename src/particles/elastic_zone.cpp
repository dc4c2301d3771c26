// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "meltray/core/parallel.hpp"
#include "meltray/particles/patch.hpp"
#include "particles/sorted_list.hpp"

/// Solid that moves: which it is, and the cells that it moves through.
namespace meltray {

Index PatchSelector::cells_across(double distance) const {
  return static_cast<Index>(std::ceil(distance / grid_.width()));
}

/// Liquid particles come first in their cells of the patch.
bool PatchSelector::near_melt(const Patch& patch, Index k, Index cell, double distance) const {
  bool near = false;
  grid_.for_block(cell, cells_across(distance), [&](Index c) {
    for (Index j = patch.cell_start[c]; j < patch.cell_start[c + 1] && patch.liquid[j] && !near; ++j) {
      double r2 = 0;
      for (int a = 0; a < patch.dim; ++a) {
        double x = patch.x[a][k] - patch.x[a][j];
        if (const double period = grid_.period()[a]; period > 0) x -= period * std::rint(x / period);
        r2 += x * x;
      }
      near = r2 < distance * distance;
    }
  });
  return near;
}

void PatchSelector::mark_elastic(Particles& particles, Patch& patch, double distance) {
  const bool everything = core_.empty();
  const auto rank = [](Elastic e) { return static_cast<std::uint8_t>(e); };
  patch.elastic.assign(patch.size(), rank(Elastic::none));
  moves_.assign(particles.size(), 0);
  parallel_for(static_cast<std::ptrdiff_t>(patch.cells.size()), [&](std::ptrdiff_t c) {
    const Index cell = patch.cells[c];
    for (Index k = patch.cell_start[cell]; k < patch.cell_start[cell + 1]; ++k) {
      const Index i = patch.global[k];
      if (patch.liquid[k] || patch.wall[k] || !(everything || near_melt(patch, k, cell, distance))) continue;
      const bool clamped = particles.has(i, kClamped);
      patch.elastic[k] = rank(clamped ? Elastic::clamped : Elastic::free);
      moves_[i] = !clamped;
    }
  });
  parallel_for(static_cast<std::ptrdiff_t>(particles.size()), [&](std::ptrdiff_t i) {
    if (particles.has(i, kMobile) && !moves_[i])
      for (int c = 0; c < particles.dim; ++c) particles.v[c][i] = 0;
    particles.flags[i] =
        static_cast<std::uint8_t>((particles.flags[i] & ~kMobile) | (moves_[i] ? kMobile : 0));
  });
  parallel_for(patch.size(), [&](Index k) {
    if (!patch.liquid[k] && !patch.wall[k] && !patch.elastic[k])
      for (int c = 0; c < patch.dim; ++c) patch.v[c][k] = 0;
  });
}

void PatchSelector::follow(const Particles& particles, const Patch& patch) {
  const auto before = view(particles.x), after = view(patch.x);
  for (Index k = 0; k < patch.size(); ++k) {
    if (patch.elastic[k] != static_cast<std::uint8_t>(Elastic::free)) continue;
    const Index i = patch.global[k], from = grid_.cell(before, i), to = grid_.cell(after, k);
    if (from == to) continue;
    erase_sorted(resting_[from], i);
    insert_sorted(resting_[to], i);
  }
}

}  // namespace meltray
