// SPDX-License-Identifier: MIT
#include "meltray/sph/clusters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meltray/core/memory.hpp"
#include "meltray/core/parallel.hpp"
#include "meltray/sph/pairs.hpp"
#include "sph/list_size.hpp"

namespace meltray::sph {

namespace {

/// Width of a column in spacings: eight particles of a lattice then fill a cube, in 2-D a square.
constexpr double kColumnWidth3 = 2, kColumnWidth2 = 2.83;
constexpr Index kOctetsPerBlock = 64;

double wrapped(double x, double period) {
  return period > 0 ? x - period * std::floor(x / period) : x;
}

}  // namespace

Index ClusterSet::column_of(const std::array<double, 3>& x) const {
  Index k[2] = {0, 0};
  for (int c = 0; c < dim_ - 1; ++c)
    k[c] = std::clamp(static_cast<Index>((x[c] - origin_[c]) * inverse_width_[c]), Index{0}, columns_[c] - 1);
  return k[0] * columns_[1] + k[1];  // in the order of the grid's cells
}

void ClusterSet::sort(const Patch& patch, const std::vector<std::uint8_t>& chosen, std::uint8_t kind,
                      double spacing, const std::array<double, 3>& period) {
  dim_ = patch.dim;
  period_ = period;
  const int up = dim_ - 1;
  constexpr double kMost = std::numeric_limits<double>::max();
  all_ = {{kMost, kMost, kMost}, {-kMost, -kMost, -kMost}};
  const auto position = [&](Index i) {
    std::array<double, 3> x{};
    for (int c = 0; c < dim_; ++c) x[c] = wrapped(patch.x[c][i], period_[c]);
    return x;
  };
  Index count = 0;
  for (Index i = 0; i < patch.size(); ++i) {
    if (chosen[i] != kind) continue;
    ++count;
    const auto x = position(i);
    for (int c = 0; c < dim_; ++c) {
      all_.min[c] = std::min(all_.min[c], x[c]);
      all_.max[c] = std::max(all_.max[c], x[c]);
    }
  }
  // Spray far from the melt must not make columns by the million: they grow until there are no more of them
  // than particles.
  double width = (dim_ == 3 ? kColumnWidth3 : kColumnWidth2) * spacing;
  for (bool too_many = count > 0; too_many; width *= 1.5) {
    double columns = 1;
    for (int c = 0; c < up; ++c) {
      columns_[c] = static_cast<Index>(std::min((all_.max[c] - all_.min[c]) / width, 1e4)) + 1;
      columns *= columns_[c];
      origin_[c] = all_.min[c];
      inverse_width_[c] = 1 / width;
    }
    too_many = columns > count + 1;
  }
  if (dim_ == 2 || count == 0) columns_[1] = 1;
  if (count == 0) columns_[0] = 1;

  const Index columns = columns_[0] * columns_[1];
  std::vector<Index> in_column(columns, 0);
  std::vector<std::pair<Index, Index>> of_column;
  of_column.reserve(count);
  for (Index i = 0; i < patch.size(); ++i)
    if (chosen[i] == kind) {
      of_column.emplace_back(column_of(position(i)), i);
      ++in_column[of_column.back().first];
    }
  column_start_.assign(columns + 1, 0);
  for (Index c = 0; c < columns; ++c)
    column_start_[c + 1] = column_start_[c] + (in_column[c] + kLanes - 1) / kLanes;
  const Index octets = column_start_[columns];
  particle_.assign(static_cast<std::size_t>(octets) * kLanes, -1);
  std::vector<Index> filled(columns, 0);
  for (const auto& [column, i] : of_column)
    particle_[static_cast<std::size_t>(column_start_[column]) * kLanes + filled[column]++] = i;
  const auto height = [&](Index i) { return wrapped(patch.x[up][i], period_[up]); };
#pragma omp parallel for schedule(dynamic, 16)
  for (Index c = 0; c < columns; ++c) {
    const auto begin = particle_.begin() + static_cast<std::ptrdiff_t>(column_start_[c]) * kLanes;
    std::sort(begin, begin + filled[c], [&](Index a, Index b) {
      const double za = height(a), zb = height(b);
      return za != zb ? za < zb : a < b;
    });
  }

  for (int c = 0; c < dim_; ++c) position_[c].resize(particle_.size());
  box_.resize(octets);
  parallel_for(octets, [&](Index o) {
    Box box{{kMost, kMost, kMost}, {-kMost, -kMost, -kMost}};
    for (Index s = o * kLanes; s < (o + 1) * kLanes; ++s)
      for (int c = 0; c < dim_; ++c) {
        const double x = particle_[s] < 0 ? kNowhere : wrapped(patch.x[c][particle_[s]], period_[c]);
        position_[c][s] = x;
        if (particle_[s] < 0) continue;
        box.min[c] = std::min(box.min[c], x);
        box.max[c] = std::max(box.max[c], x);
      }
    box_[o] = box;
  });
}

void ClusterSet::pack(const std::vector<double>& field, double empty, AlignedDoubles& out) const {
  out.resize(particle_.size());
  parallel_for(slots(), [&](Index s) { out[s] = particle_[s] < 0 ? empty : field[particle_[s]]; });
}

void ClusterSet::close() {
  free_memory(position_, box_);
}

std::size_t ClusterSet::bytes() const {
  return held_bytes(particle_, column_start_, box_) + held_bytes(position_);
}

/// Adds the lists of the groups of one octet of rows to the block.
template <int D>
void ClusterList::search(const ClusterSet& rows, const ClusterSet& sources, Index octet, double reach,
                         Block& block) {
  constexpr int up = D - 1;
  constexpr Index kGroups = kLanes / kGroupRows;
  const double reach2 = reach * reach;
  const double* const x[3] = {sources.position_[0].data(), sources.position_[1].data(),
                              sources.position_[2].data()};
  block.candidate.clear();
  block.of_group.clear();

  // Images of the rows in periodic directions.
  std::array<int, 3> image{};
  const auto search_image = [&] {
    ClusterSet::Box box = rows.box_[octet];
    std::array<double, 3> shift{};
    for (int c = 0; c < D; ++c) {
      shift[c] = image[c] * rows.period_[c];
      box.min[c] += shift[c] - reach;
      box.max[c] += shift[c] + reach;
      if (box.min[c] > sources.all_.max[c] || box.max[c] < sources.all_.min[c]) return;
    }
    double xi[D][kLanes];
    for (int c = 0; c < D; ++c)
      for (Index row = 0; row < kLanes; ++row) {
        const bool empty = rows.particle_[octet * kLanes + row] < 0;  // as far from empty slots of sources
        xi[c][row] = empty ? -kNowhere : rows.position_[c][octet * kLanes + row] + shift[c];
      }
    Index low[2] = {0, 0}, high[2] = {0, 0};
    for (int c = 0; c < up; ++c) {
      const auto column = [&](double at) {
        return std::clamp(
            static_cast<Index>(std::floor((at - sources.origin_[c]) * sources.inverse_width_[c])), Index{0},
            sources.columns_[c] - 1);
      };
      low[c] = column(box.min[c]);
      high[c] = column(box.max[c]);
    }
    for (Index b = low[1]; b <= high[1]; ++b)
      for (Index a = low[0]; a <= high[0]; ++a) {
        const Index column = a * sources.columns_[1] + b;
        const auto end = sources.box_.begin() + sources.column_start_[column + 1];
        auto source = std::partition_point(sources.box_.begin() + sources.column_start_[column], end,
                                           [&](const auto& s) { return s.max[up] < box.min[up]; });
        for (; source != end && source->min[up] <= box.max[up]; ++source) {
          bool apart = false;
          for (int c = 0; c < up; ++c)
            apart = apart || source->min[c] > box.max[c] || source->max[c] < box.min[c];
          if (apart) continue;
          const auto s = static_cast<Index>(source - sources.box_.begin());
          // All eight rows at once: no sum across a register.
          double near[kLanes] = {};
          for (Index l = 0; l < kLanes; ++l) {
            double xj[D];
            for (int c = 0; c < D; ++c) xj[c] = x[c][s * kLanes + l];
#pragma omp simd
            for (Index row = 0; row < kLanes; ++row) {
              double r2 = 0;
              for (int c = 0; c < D; ++c) r2 += (xi[c][row] - xj[c]) * (xi[c][row] - xj[c]);
              near[row] += r2 < reach2 ? 1.0 : 0.0;
            }
          }
          for (Index row = 0; row < kLanes; ++row)
            neighbours_[octet * kLanes + row] += static_cast<Index>(near[row]);
          for (Index g = 0; g < kGroups; ++g) {
            if (near[g * kGroupRows] + near[g * kGroupRows + 1] == 0) continue;
            block.candidate.push_back(s);
            block.of_group.push_back(g);
          }
        }
      }
  };
  std::array<int, 3> most{};
  for (int c = 0; c < D; ++c) most[c] = rows.period_[c] > 0 ? 1 : 0;
  for (image[2] = -most[2]; image[2] <= most[2]; ++image[2])
    for (image[1] = -most[1]; image[1] <= most[1]; ++image[1])
      for (image[0] = -most[0]; image[0] <= most[0]; ++image[0]) search_image();

  const bool periodic = most[0] + most[1] + most[2] > 0;
  for (Index g = 0; g < kGroups; ++g) {
    const auto first = static_cast<std::ptrdiff_t>(block.octet.size());
    for (std::size_t k = 0; k < block.candidate.size(); ++k)
      if (block.of_group[k] == g) block.octet.push_back(block.candidate[k]);
    if (periodic) {  // an octet that spans its column may be met in two images
      std::sort(block.octet.begin() + first, block.octet.end());
      block.octet.erase(std::unique(block.octet.begin() + first, block.octet.end()), block.octet.end());
    }
    block.count.push_back(static_cast<Index>(block.octet.size() - first));
  }
}

void ClusterList::build(const ClusterSet& rows, const ClusterSet& sources, double reach) {
  const Index octets = rows.octets(), blocks = (octets + kOctetsPerBlock - 1) / kOctetsPerBlock;
  free_memory(octet_);
  std::vector<Block> found(blocks);
  neighbours_.assign(rows.slots(), 0);
  with_dim(rows.dim_, [&](auto d) {
#pragma omp parallel for schedule(dynamic, 1)
    for (Index b = 0; b < blocks; ++b) {
      Block& block = found[b];
      for (Index o = b * kOctetsPerBlock; o < std::min(octets, (b + 1) * kOctetsPerBlock); ++o)
        if (sources.octets() > 0)
          search<d>(rows, sources, o, reach, block);
        else
          block.count.insert(block.count.end(), kLanes / kGroupRows, 0);
    }
  });
  start_.assign(rows.groups() + 1, 0);
  Index group = 0;
  std::int64_t octets_listed = 0;
  for (const Block& b : found)
    for (const Index n : b.count) {
      octets_listed += n;
      start_[++group] = static_cast<Index>(octets_listed);
    }
  require_indexable(octets_listed, "list of octets");
  octet_.resize(start_[group]);
#pragma omp parallel for schedule(static)
  for (Index b = 0; b < blocks; ++b)
    std::copy(found[b].octet.begin(), found[b].octet.end(),
              octet_.begin() + start_[b * kOctetsPerBlock * (kLanes / kGroupRows)]);
}

}  // namespace meltray::sph
