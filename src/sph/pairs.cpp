// SPDX-License-Identifier: MIT
#include "meltray/sph/pairs.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "meltray/core/memory.hpp"
#include "sph/eight_candidates.hpp"
#include "sph/list_size.hpp"

namespace meltray::sph {

namespace {

/// Cells of the patch handled by one task; fixed, so that the list does not depend on the number of threads.
constexpr Index kCellsPerBlock = 32, kCellsPerBlockOfPiece = 8;
/// Widens the reach of the search by more than single precision loses over a cell and its neighbours.
constexpr float kRounding = 1.00001f;
/// Smoothing length of what fills up the candidates: nothing is less than a reach that is not a number.
constexpr float kNoReach = std::numeric_limits<float>::quiet_NaN();

}  // namespace

void PairList::search(const Patch& patch, const CellGrid& grid, double skin, std::span<const Index> cells,
                      Index block_cells) {
  const auto count = static_cast<Index>(cells.size());
  const Index blocks = (count + block_cells - 1) / block_cells;
  const std::vector<std::uint8_t>& wanted = wanted_;
  blocks_.resize(blocks);
  with_dim(dim_, [&](auto d) {
#pragma omp parallel for schedule(dynamic, 1)
    for (Index b = 0; b < blocks; ++b) {
      for (const Index cell :
           cells.subspan(b * block_cells, std::min(block_cells, count - b * block_cells))) {
        const Index first = patch.cell_start[cell], last = patch.cell_start[cell + 1];
        if (std::none_of(wanted.begin() + first, wanted.begin() + last, [](auto w) { return w != 0; }))
          continue;
        gather_candidates<d>(patch, grid, cell, blocks_[b]);
        for (Index i = first; i < last; ++i)
          if (wanted[i]) search_row<d>(patch, i, first, skin, blocks_[b]);
      }
    }
  });
}

/// Particles of a cell and those around it, side by side, relative to the first particle of the cell.
template <int D>
void PairList::gather_candidates(const Patch& patch, const CellGrid& grid, Index cell, Block& block) const {
  block.candidate.clear();
  grid.for_block(cell, 1, [&](Index near) {
    for (Index j = patch.cell_start[near]; j < patch.cell_start[near + 1]; ++j) block.candidate.push_back(j);
  });
  const Index n = static_cast<Index>(block.candidate.size()), origin = patch.cell_start[cell];
  const Index filled = (n + kCandidates - 1) / kCandidates * kCandidates;
  block.candidate.resize(filled, origin);
  for (int c = 0; c < D; ++c) {
    block.candidate_x[c].resize(filled);
    for (Index k = 0; k < n; ++k)
      block.candidate_x[c][k] =
          static_cast<float>(nearest(c, patch.x[c][block.candidate[k]] - patch.x[c][origin]));
  }
  block.candidate_h.resize(filled);
  for (Index k = 0; k < n; ++k)
    block.candidate_h[k] = static_cast<float>(patch.smoothing[block.candidate[k]]);
  std::fill(block.candidate_h.begin() + n, block.candidate_h.end(), kNoReach);
}

/// Appends the candidates within reach of particle i of the cell that starts with particle `origin`.
template <int D>
void PairList::search_row(const Patch& patch, Index i, Index origin, double skin, Block& block) const {
  const Index n = static_cast<Index>(block.candidate.size());
  SearchedRow<D> row{};
  bool periodic = false;
  for (int c = 0; c < D; ++c) {
    row.x[c] = static_cast<float>(nearest(c, patch.x[c][i] - patch.x[c][origin]));
    row.period[c] = static_cast<float>(period_[c]);
    row.inverse_period[c] = period_[c] > 0 ? static_cast<float>(1 / period_[c]) : 0.0f;
    periodic = periodic || period_[c] > 0;
  }
  row.reach = static_cast<float>(kRounding * (patch.smoothing[i] + skin));
  row.rounding = kRounding;

  if (const std::size_t least = block.used + n; block.entries.size() < least) {
    block.entries.reserve(least + least / 8);
    block.entries.resize(least + least / 8);
  }
  const auto take = [&](auto wraps) {
    Index* out = block.entries.data() + block.used;
    for (Index k = 0; k < n; k += kCandidates) {
      const std::array<const float*, 3> x{block.candidate_x[0].data() + k, block.candidate_x[1].data() + k,
                                          block.candidate_x[2].data() + k};
      const unsigned mask = within_reach<D, wraps>(row, x, block.candidate_h.data() + k);
      out += take_marked(block.candidate.data() + k, mask, i, out);
    }
    return static_cast<Index>(out - (block.entries.data() + block.used));
  };
  const Index found = periodic ? take(std::true_type{}) : take(std::false_type{});
  block.used += found;
  block.row.push_back(i);
  block.count.push_back(found);
}

void PairList::clear_blocks() {
  for (Block& b : blocks_) {
    b.row.clear();
    b.count.clear();
    b.used = 0;
  }
}

void PairList::build(const Patch& patch, const CellGrid& grid, double skin,
                     const std::vector<std::uint8_t>& extra) {
  dim_ = patch.dim;
  period_ = grid.period();
  const Index n = patch.size();
  clear_blocks();

  wanted_.assign(n, 0);
  for (Index i = 0; i < n; ++i) wanted_[i] = patch.liquid[i] || (!extra.empty() && extra[i]);
  search(patch, grid, skin, patch.cells, kCellsPerBlock);

  next_to_melt_.assign(n, 0);
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t block = 0; block < blocks_.size(); ++block) {
    const Block& b = blocks_[block];
    std::size_t k = 0;
    for (std::size_t r = 0; r < b.row.size(); ++r) {
      const std::size_t end = k + b.count[r];
      if (patch.liquid[b.row[r]])
        for (; k < end; ++k)  // several blocks may mark the same particle
          if (const Index j = b.entries[k]; !patch.liquid[j])
            std::atomic_ref(next_to_melt_[j]).store(1, std::memory_order_relaxed);
      k = end;
    }
  }
  bool more = false;
  for (Index i = 0; i < n; ++i) {
    wanted_[i] = next_to_melt_[i] && !wanted_[i];
    more = more || wanted_[i];
  }
  if (more) search(patch, grid, skin, patch.cells, kCellsPerBlock);

  next_to_wall_.assign(n, 0);
  start_.resize(n + 1);
  count_.resize(n);
  place_rows(0, n);
  copy_blocks(patch);
}

void PairList::build_piece(const Patch& patch, const CellGrid& grid, double skin,
                           std::span<const Index> cells) {
  dim_ = patch.dim;
  period_ = grid.period();
  const Index n = patch.size(), begin = patch.cell_start[cells.front()],
              end = patch.cell_start[cells.back() + 1];
  clear_blocks();
  wanted_.resize(n);
  next_to_wall_.resize(n);
  start_.resize(n + 1);
  count_.resize(n);
  for (Index i = begin; i < end; ++i) wanted_[i] = !patch.wall[i];
  search(patch, grid, skin, cells, kCellsPerBlockOfPiece);

  place_rows(begin, end);
  copy_blocks(patch);
}

/// Places for the rows [begin, end) that the blocks have found.
void PairList::place_rows(Index begin, Index end) {
  std::fill(count_.begin() + begin, count_.begin() + end, 0);
  pairs_ = 0;
  for (const Block& b : blocks_)
    for (std::size_t r = 0; r < b.row.size(); ++r) {
      count_[b.row[r]] = b.count[r];
      pairs_ += b.count[r];
    }
  start_[begin] = 0;
  std::int64_t places = 0;
  for (Index i = begin; i < end; ++i) {
    places += (count_[i] + kLaneCount - 1) / kLaneCount * kLaneCount;
    start_[i + 1] = static_cast<Index>(places);
  }
  require_indexable(places, "pair list");
  resize_anew(j_, start_[end]);
}

/// The rows that the blocks have found, to their places in the list.
void PairList::copy_blocks(const Patch& patch) {
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    std::size_t k = 0;
    for (std::size_t r = 0; r < block.row.size(); ++r) {
      const Index row = block.row[r];
      std::copy_n(block.entries.begin() + k, block.count[r], j_.begin() + start_[row]);
      std::fill(j_.begin() + end(row), j_.begin() + filled_end(row), row);
      std::uint8_t wall = 0;
      for (Index e = 0; e < block.count[r]; ++e) wall |= patch.wall[block.entries[k + e]];
      next_to_wall_[row] = wall != 0;
      k += block.count[r];
    }
  }
}

void PairList::refresh(const Patch& patch, KernelType kernel) {
  refresh_with(patch, kernel, nullptr);
}

void PairList::refresh(const Patch& patch, KernelType kernel, const std::vector<Index>& rows) {
  refresh_with(patch, kernel, &rows);
}

void PairList::refresh_with(const Patch& patch, KernelType kernel, const std::vector<Index>* some) {
  for (int c = 0; c < dim_; ++c) resize_anew(dx_[c], slots());
  resize_anew(w_, slots());
  resize_anew(f_, slots());
  const bool periodic = std::any_of(period_.begin(), period_.begin() + dim_, [](double p) { return p > 0; });
  with_dim(dim_, [&](auto d) {
    with_kernel<d>(kernel, [&](auto k) {
      if (periodic)
        refresh_rows<d, decltype(k), true>(patch, some);
      else
        refresh_rows<d, decltype(k), false>(patch, some);
    });
  });
}

template <int D, class Kernel, bool Periodic>
void PairList::refresh_rows(const Patch& patch, const std::vector<Index>* some) {
  std::array<double, 3> inverse_period{};
  for (int c = 0; c < D; ++c) inverse_period[c] = period_[c] > 0 ? 1 / period_[c] : 0;

  const auto x = view(patch.x);
  const double* const h = patch.smoothing.data();
  const Index* const j = j_.data();
  float* const dx[3] = {dx_[0].data(), dx_[1].data(), dx_[2].data()};
  float *const w = w_.data(), *const f = f_.data();
  const auto period = period_;
  const auto refresh_row = [&](Index i) {
    const double hi = h[i];
    double xi[D];
    for (int c = 0; c < D; ++c) xi[c] = x[c][i];
    const Index first = start_[i], last = filled_end(i);
#pragma omp simd
    for (Index k = first; k < last; ++k) {
      double r2 = 0;
      for (int c = 0; c < D; ++c) {
        double s = xi[c] - x[c][j[k]];
        if constexpr (Periodic) s -= period[c] * std::rint(s * inverse_period[c]);
        dx[c][k] = static_cast<float>(s);
        r2 += s * s;
      }
      const double r = std::sqrt(r2), inv_h = 2 / (hi + h[j[k]]);
      w[k] = static_cast<float>(Kernel::w(r, inv_h));
      f[k] = static_cast<float>(Kernel::f(r, inv_h));
    }
    for (Index k = end(i); k < last; ++k) w[k] = f[k] = 0;
  };
  if (some)
    parallel_for(static_cast<std::ptrdiff_t>(some->size()),
                 [&](std::ptrdiff_t n) { refresh_row((*some)[n]); });
  else
    parallel_for_uneven(rows(), refresh_row);
}

std::size_t PairList::bytes() const {
  std::size_t n =
      held_bytes(start_, count_, j_, w_, f_, next_to_melt_, next_to_wall_, wanted_) + held_bytes(dx_);
  for (const Block& b : blocks_) n += held_bytes(b.row, b.count, b.entries, b.candidate, b.candidate_h);
  return n;
}

}  // namespace meltray::sph
