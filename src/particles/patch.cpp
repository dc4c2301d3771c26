// SPDX-License-Identifier: MIT
#include "meltray/particles/patch.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "meltray/core/collect.hpp"
#include "meltray/core/memory.hpp"
#include "meltray/core/parallel.hpp"
#include "particles/sorted_list.hpp"

namespace meltray {

namespace {

/// What has been done around a cell in this selection (core_).
constexpr std::uint8_t kReached = 1, kSurrounded = 2;

bool moves(const Particles& p, Index i) {
  return p.is_liquid(i) && !p.has(i, kRemoved);
}

}  // namespace

PatchSelector::PatchSelector(const CellGrid& grid, const Particles& particles) : grid_(grid) {
  const auto x = view(particles.x);
  const auto count = static_cast<Index>(particles.size());
  const auto rests = [&](Index i) { return !particles.has(i, kRemoved) && !moves(particles, i); };
  std::vector<Index> in_cell(grid.cells(), 0);
  for (Index i = 0; i < count; ++i)
    if (rests(i)) ++in_cell[grid_.cell(x, i)];
  resting_.resize(grid.cells());
  for (Index cell = 0; cell < grid.cells(); ++cell) resting_[cell].reserve(in_cell[cell]);
  for (Index i = 0; i < count; ++i)
    if (rests(i))
      resting_[grid_.cell(x, i)].push_back(i);
    else if (moves(particles, i))
      moving_.push_back(i);
}

void PatchSelector::melted(const Particles& particles, Index i) {
  erase_sorted(resting_[grid_.cell(view(particles.x), i)], i);
  insert_sorted(moving_, i);
}

void PatchSelector::solidified(const Particles& particles, Index i) {
  insert_sorted(resting_[grid_.cell(view(particles.x), i)], i);
  erase_sorted(moving_, i);
}

void PatchSelector::select_all(const Particles& particles, Patch& patch) {
  core_.clear();
  marked_.assign(grid_.cells(), 1);
  marked_cells_.resize(grid_.cells());
  std::iota(marked_cells_.begin(), marked_cells_.end(), 0);
  sort_moving(particles);
  fill(particles, patch);
}

/// Forgets the last selection; costs what that selection cost, not what the box holds.
void PatchSelector::unmark() {
  core_.resize(grid_.cells(), 0);
  marked_.resize(grid_.cells(), 0);
  for (const Index cell : marked_cells_) core_[cell] = marked_[cell] = 0;
  marked_cells_.clear();
}

void PatchSelector::mark(Index cell) {
  if (!marked_[cell]) marked_cells_.push_back(cell);
  marked_[cell] = 1;
}

/// Marks a cell and those next to it.
void PatchSelector::mark_block(Index cell) {
  if (core_[cell] & kSurrounded) return;
  core_[cell] |= kSurrounded;
  grid_.for_block(cell, 1, [&](Index k) { mark(k); });
}

/// Marks the cells that may hold something within `reach` cell widths of the moving particles of a cell.
void PatchSelector::mark_near(const Particles& particles, Index cell, Index reach) {
  if (core_[cell] & kReached) return;
  core_[cell] |= kReached;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  for (int c = 0; c < particles.dim; ++c) {
    const auto [least, most] = std::minmax_element(
        moving_sorted_.begin() + moving_start_[cell], moving_sorted_.begin() + moving_start_[cell + 1],
        [&](Index a, Index b) { return particles.x[c][a] < particles.x[c][b]; });
    low[c] = particles.x[c][*least];
    high[c] = particles.x[c][*most];
  }
  grid_.for_near(cell, reach, reach * grid_.width(), low, high, [&](Index k) { mark(k); });
}

void PatchSelector::select_near_melt(const Particles& particles, std::span<const Index> also, Patch& patch,
                                     Index reach) {
  unmark();
  sort_moving(particles);
  for (const Index cell : moving_cell_) mark_near(particles, cell, reach);
  const auto x = view(particles.x);
  for (Index i : also) mark_block(grid_.cell(x, i));
  std::sort(marked_cells_.begin(), marked_cells_.end());
  fill(particles, patch);
}

void PatchSelector::select_around(const Particles& particles, std::span<const Index> centres, Patch& patch) {
  unmark();
  const auto x = view(particles.x);
  for (Index i : centres) mark_block(grid_.cell(x, i));
  std::sort(marked_cells_.begin(), marked_cells_.end());
  sort_moving(particles);
  fill(particles, patch);
}

void PatchSelector::gather(const Particles& particles, const Vec3& min, const Vec3& max,
                           std::vector<Index>& out) const {
  const auto x = view(particles.x);
  const auto take = [&](Index i, std::vector<Index>& found) {
    for (int c = 0; c < particles.dim; ++c)
      if (x[c][i] < min[c] || x[c][i] > max[c]) return;
    found.push_back(i);
  };
  std::vector<Index> cells;
  grid_.for_box(min, max, [&](Index cell) { cells.push_back(cell); });
  const auto resting = static_cast<std::ptrdiff_t>(cells.size()),
             moving = static_cast<std::ptrdiff_t>(moving_.size());
  parallel_collect(resting + moving, 256, out, [&](std::ptrdiff_t k, std::vector<Index>& found) {
    if (k < resting)
      for (Index i : resting_[cells[k]]) take(i, found);
    else if (!particles.has(moving_[k - resting], kRemoved))
      take(moving_[k - resting], found);
  });
}

/// Counting sort of the moving particles by cell; ascending indices within a cell.
void PatchSelector::sort_moving(const Particles& particles) {
  const auto x = view(particles.x);
  std::erase_if(moving_, [&](Index i) { return particles.has(i, kRemoved); });
  const Index cells = grid_.cells();
  moving_start_.assign(cells + 1, 0);
  moving_cell_.resize(moving_.size());
  parallel_for(static_cast<std::ptrdiff_t>(moving_.size()),
               [&](std::ptrdiff_t k) { moving_cell_[k] = grid_.cell(x, moving_[k]); });
  for (const Index cell : moving_cell_) ++moving_start_[cell + 1];
  for (Index c = 0; c < cells; ++c) moving_start_[c + 1] += moving_start_[c];
  moving_sorted_.resize(moving_.size());
  for (std::size_t k = 0; k < moving_.size(); ++k)
    moving_sorted_[moving_start_[moving_cell_[k]]++] = moving_[k];
  for (Index c = cells; c > 0; --c) moving_start_[c] = moving_start_[c - 1];
  moving_start_[0] = 0;
}

/// The marked cells' resting particles and the moving ones that sort_moving() has sorted.
void PatchSelector::fill(const Particles& particles, Patch& patch) {
  const Index cells = grid_.cells();
  patch.dim = particles.dim;
  patch.global.clear();
  patch.cells = marked_cells_;
  patch.cell_start.resize(cells + 1);
  Index next = 0;
  for (const Index c : marked_cells_) {
    std::fill(patch.cell_start.begin() + next, patch.cell_start.begin() + c + 1, patch.size());
    next = c + 1;
    patch.global.insert(patch.global.end(), moving_sorted_.begin() + moving_start_[c],
                        moving_sorted_.begin() + moving_start_[c + 1]);
    patch.global.insert(patch.global.end(), resting_[c].begin(), resting_[c].end());
  }
  std::fill(patch.cell_start.begin() + next, patch.cell_start.end(), patch.size());

  reload(particles, patch);
}

std::size_t PatchSelector::bytes() const {
  std::size_t n = held_bytes(resting_, moving_, core_, marked_, marked_cells_, moves_, moving_cell_,
                             moving_sorted_, moving_start_);
  for (const auto& cell : resting_) n += held_bytes(cell);
  return n;
}

std::size_t Patch::bytes() const {
  return held_bytes(global, cells, cell_start, h, mass, smoothing, pressure, density, liquid, wall, elastic) +
         held_bytes(x) + held_bytes(v) + held_bytes(stress);
}

void reload(const Particles& particles, Patch& patch) {
  const Index n = patch.size();
  for (int c = 0; c < particles.dim; ++c) {
    patch.x[c].resize(n);
    patch.v[c].resize(n);
  }
  patch.h.resize(n);
  patch.mass.resize(n);
  patch.smoothing.resize(n);
  patch.pressure.resize(n);
  const bool dense = !particles.density.empty();
  if (dense) patch.density.resize(n);
  const int stresses = particles.stress[0].empty() ? 0 : symmetric_count(particles.dim);
  for (int c = 0; c < stresses; ++c) patch.stress[c].resize(n);
  patch.liquid.resize(n);
  patch.wall.resize(n);
  parallel_for(n, [&](Index k) {
    const Index i = patch.global[k];
    for (int c = 0; c < particles.dim; ++c) {
      patch.x[c][k] = particles.x[c][i];
      patch.v[c][k] = particles.v[c][i];
    }
    patch.h[k] = particles.h[i];
    patch.mass[k] = particles.mass[i];
    patch.smoothing[k] = particles.smoothing[i];
    patch.pressure[k] = particles.pressure[i];
    if (dense) patch.density[k] = particles.density[i];
    for (int c = 0; c < stresses; ++c) patch.stress[c][k] = particles.stress[c][i];
    patch.liquid[k] = particles.is_liquid(i);
    patch.wall[k] = particles.wall[i];
  });
}

void write_back(const Patch& patch, Particles& particles) {
  const bool dense = !particles.density.empty(), elastic = !patch.elastic.empty();
  parallel_for(patch.size(), [&](Index k) {
    const Index i = patch.global[k];
    if (elastic && patch.elastic[k])
      for (int c = 0; c < symmetric_count(patch.dim); ++c) particles.stress[c][i] = patch.stress[c][k];
    if (patch.liquid[k] || (elastic && patch.elastic[k]))
      for (int c = 0; c < patch.dim; ++c) {
        particles.x[c][i] = patch.x[c][k];
        particles.v[c][i] = patch.v[c][k];
      }
    particles.h[i] = patch.h[k];
    particles.pressure[i] = patch.pressure[k];
    if (dense) particles.density[i] = patch.density[k];
  });
}

}  // namespace meltray
