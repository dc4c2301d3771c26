// SPDX-License-Identifier: MIT
#include "meltray/sph/pairs.hpp"

#include <cmath>

namespace meltray::sph {

namespace {

/// Consecutive cells handled by one task; fixed, so that the list does not depend on the number of threads.
constexpr Index kCellsPerBlock = 128;

}  // namespace

void PairList::search(const Patch& patch, const CellGrid& grid, double skin,
                      const std::vector<std::uint8_t>& wanted) {
  const Index cells = grid.cells(), blocks = (cells + kCellsPerBlock - 1) / kCellsPerBlock;
  blocks_.resize(blocks);
  const int dim = dim_;
  std::array<double, 3> inverse_period{};
  for (int c = 0; c < dim; ++c) inverse_period[c] = period_[c] > 0 ? 1 / period_[c] : 0;

#pragma omp parallel for schedule(dynamic, 1)
  for (Index b = 0; b < blocks; ++b) {
    Block& block = blocks_[b];
    const Index last_cell = std::min(cells, (b + 1) * kCellsPerBlock);
    for (Index cell = b * kCellsPerBlock; cell < last_cell; ++cell) {
      const Index first = patch.cell_start[cell], last = patch.cell_start[cell + 1];
      bool any = false;
      for (Index i = first; i < last; ++i) any = any || wanted[i];
      if (!any) continue;

      // Candidates of the whole cell, copied side by side so that the distance test runs over plain arrays.
      block.candidate.clear();
      grid.for_block(cell, 1, [&](Index near) {
        for (Index j = patch.cell_start[near]; j < patch.cell_start[near + 1]; ++j)
          block.candidate.push_back(j);
      });
      const Index n = static_cast<Index>(block.candidate.size());
      for (int c = 0; c < dim; ++c) {
        block.candidate_x[c].resize(n);
        for (Index k = 0; k < n; ++k) block.candidate_x[c][k] = patch.x[c][block.candidate[k]];
      }
      block.candidate_h.resize(n);
      block.r2.resize(n);
      for (Index k = 0; k < n; ++k) block.candidate_h[k] = patch.smoothing[block.candidate[k]];

      for (Index i = first; i < last; ++i) {
        if (!wanted[i]) continue;
        double* const r2 = block.r2.data();
        for (Index k = 0; k < n; ++k) r2[k] = 0;
        for (int c = 0; c < dim; ++c) {
          const double xi = patch.x[c][i], length = period_[c], inverse = inverse_period[c];
          const double* const xj = block.candidate_x[c].data();
#pragma omp simd
          for (Index k = 0; k < n; ++k) {
            double d = xi - xj[k];
            d -= length * std::rint(d * inverse);
            r2[k] += d * d;
          }
        }
        const double hi = patch.smoothing[i];
        const std::size_t before = block.entries.size();
        block.entries.resize(before + n);
        Index* out = block.entries.data() + before;
        Index found = 0;
        for (Index k = 0; k < n; ++k) {
          const double reach = hi + block.candidate_h[k] + skin;
          out[found] = block.candidate[k];
          found += (r2[k] < reach * reach) & (block.candidate[k] != i);
        }
        block.entries.resize(before + found);
        block.row.push_back(i);
        block.count.push_back(found);
      }
    }
  }
}

void PairList::build(const Patch& patch, const CellGrid& grid, double skin,
                     const std::vector<std::uint8_t>& extra) {
  dim_ = patch.dim;
  period_ = grid.period();
  const Index n = patch.size();
  for (Block& b : blocks_) {
    b.row.clear();
    b.count.clear();
    b.entries.clear();
  }

  wanted_.assign(n, 0);
  for (Index i = 0; i < n; ++i) wanted_[i] = patch.liquid[i] || (!extra.empty() && extra[i]);
  search(patch, grid, skin, wanted_);

  next_to_melt_.assign(n, 0);
  for (const Block& b : blocks_) {
    std::size_t k = 0;
    for (std::size_t r = 0; r < b.row.size(); ++r) {
      const std::size_t end = k + b.count[r];
      if (patch.liquid[b.row[r]])
        for (; k < end; ++k) next_to_melt_[b.entries[k]] = 1;
      k = end;
    }
  }
  bool more = false;
  for (Index i = 0; i < n; ++i) {
    next_to_melt_[i] = next_to_melt_[i] && !patch.liquid[i];
    wanted_[i] = next_to_melt_[i] && !wanted_[i];
    more = more || wanted_[i];
  }
  if (more) search(patch, grid, skin, wanted_);

  next_to_wall_.assign(n, 0);
  start_.assign(n + 1, 0);
  for (const Block& b : blocks_)
    for (std::size_t r = 0; r < b.row.size(); ++r) start_[b.row[r] + 1] = b.count[r];
  for (Index i = 0; i < n; ++i) start_[i + 1] += start_[i];
  const std::size_t pairs = start_[n];
  j_.resize(pairs);
  for (int c = 0; c < dim_; ++c) dx_[c].resize(pairs);
  w_.resize(pairs);
  f_.resize(pairs);
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    std::size_t k = 0;
    for (std::size_t r = 0; r < block.row.size(); ++r) {
      const Index row = block.row[r];
      std::copy_n(block.entries.begin() + k, block.count[r], j_.begin() + start_[row]);
      std::uint8_t wall = 0;
      for (Index e = 0; e < block.count[r]; ++e) wall |= patch.wall[block.entries[k + e]];
      next_to_wall_[row] = wall != 0;
      k += block.count[r];
    }
  }
}

void PairList::refresh(const Patch& patch, KernelType kernel) {
  refresh_rows(patch, kernel, rows(), [](std::ptrdiff_t i) { return static_cast<Index>(i); });
}

void PairList::refresh(const Patch& patch, KernelType kernel, const std::vector<Index>& rows) {
  refresh_rows(patch, kernel, static_cast<Index>(rows.size()),
               [&](std::ptrdiff_t k) { return rows[static_cast<std::size_t>(k)]; });
}

template <class RowAt>
void PairList::refresh_rows(const Patch& patch, KernelType kernel, Index count, RowAt&& row_at) {
  std::array<double, 3> inverse_period{};
  for (int c = 0; c < dim_; ++c) inverse_period[c] = period_[c] > 0 ? 1 / period_[c] : 0;
  with_dim(dim_, [&](auto d) {
    constexpr int D = d;
    with_kernel<D>(kernel, [&](auto k) {
      using Kernel = decltype(k);
      const auto x = view(patch.x);
      const double* const h = patch.smoothing.data();
      const Index* const j = j_.data();
      double* const dx[3] = {dx_[0].data(), dx_[1].data(), dx_[2].data()};
      double *const w = w_.data(), *const f = f_.data();
      const auto period = period_;
      parallel_for(count, [&](std::ptrdiff_t n) {
        const Index i = row_at(n);
        const double hi = h[i];
        double xi[D];
        for (int c = 0; c < D; ++c) xi[c] = x[c][i];
        const Index first = start_[i], last = start_[i + 1];
#pragma omp simd
        for (Index k = first; k < last; ++k) {
          double r2 = 0;
          for (int c = 0; c < D; ++c) {
            double s = xi[c] - x[c][j[k]];
            s -= period[c] * std::rint(s * inverse_period[c]);
            dx[c][k] = s;
            r2 += s * s;
          }
          const double r = std::sqrt(r2), inv_h = 2 / (hi + h[j[k]]);
          w[k] = Kernel::w(r, inv_h);
          f[k] = Kernel::f(r, inv_h);
        }
      });
    });
  });
}

std::size_t PairList::bytes() const {
  return j_.capacity() * sizeof(Index) +
         (dx_[0].capacity() + dx_[1].capacity() + dx_[2].capacity() + w_.capacity() + f_.capacity()) *
             sizeof(double);
}

}  // namespace meltray::sph
