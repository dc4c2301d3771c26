// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <type_traits>
#include <vector>

#include "meltray/core/parallel.hpp"
#include "meltray/core/vec.hpp"
#include "meltray/particles/patch.hpp"
#include "meltray/sph/kernel.hpp"
#include "meltray/sph/lanes.hpp"

/// Pair loops. Terms see a pair only through `Pair` and `sum_row`, so that the layout of the list can change
/// without touching them.
namespace meltray::sph {

/// Calls f(std::integral_constant<int, D>) for D = dim.
template <class F>
decltype(auto) with_dim(int dim, F&& f) {
  return dim == 2 ? f(std::integral_constant<int, 2>{}) : f(std::integral_constant<int, 3>{});
}

/// Neighbour j of particle i with the geometry of the current stage: x_ij = x_i - x_j, W_ij, F_ij = W'/r.
/// k is the position of the pair in the list, for coefficients that are stored per pair.
template <int D>
struct Pair {
  Index j, k;
  std::array<double, D> x;
  double w, f;
  double r2() const {
    double s = 0;
    for (int c = 0; c < D; ++c) s += x[c] * x[c];
    return s;
  }
};

/// kLaneCount neighbours j of particle i at a time, as in `Pair`. The last of a row may be fillers: particle
/// i itself with x, W and F of 0, so that what they add to a sum is 0.
template <int D>
struct PairLanes {
  const Index* j;
  Index k;
  std::array<Lanes, D> x;
  Lanes w, f;
  /// Values of a field at the neighbours.
  template <class T>
  Lanes of(const T* field) const {
    return gather(field, j);
  }
  Lanes r2() const {
    Lanes s = x[0] * x[0];
    for (int c = 1; c < D; ++c) s += x[c] * x[c];
    return s;
  }
};

/// Neighbours of the rows that some term needs, with their geometry. The self pair is not in the list. Rows
/// are filled up to whole registers.
class PairList {
 public:
  /// Finds the neighbours of liquid particles and of `extra` rows (1 per patch entry; empty: none), then of
  /// the solid particles that have a liquid neighbour. `skin` [m] widens the support, so that the list holds
  /// while particles move by less than half of it.
  void build(const Patch& patch, const CellGrid& grid, double skin, const std::vector<std::uint8_t>& extra);
  /// Only the rows of the particles in `cells`, consecutive ones of patch.cells, without dummies of faces: a
  /// list in pieces, for what is needed once. The other rows are undefined.
  void build_piece(const Patch& patch, const CellGrid& grid, double skin, std::span<const Index> cells);
  /// Evaluates x_ij, W_ij and F_ij at the patch's current positions. Without it the list holds neighbours
  /// only.
  void refresh(const Patch& patch, KernelType kernel);
  /// The same for some rows only; the others keep the geometry that they have.
  void refresh(const Patch& patch, KernelType kernel, const std::vector<Index>& rows);

  Index rows() const { return static_cast<Index>(count_.size()); }
  Index begin(Index i) const { return start_[i]; }
  Index end(Index i) const { return start_[i] + count_[i]; }
  /// The same with the fillers of the row.
  Index filled_end(Index i) const { return start_[i + 1]; }
  /// Neighbours of row i; 0 where there is no such row.
  Index count(Index i) const { return i < rows() ? count_[i] : 0; }
  Index neighbour(Index k) const { return j_[k]; }
  const Index* neighbours() const { return j_.data(); }
  /// 1 for solid particles with a liquid neighbour: the walls of the melt.
  const std::vector<std::uint8_t>& next_to_melt() const { return next_to_melt_; }
  /// 1 for rows with a dummy of a box face among their neighbours.
  const std::vector<std::uint8_t>& next_to_wall() const { return next_to_wall_; }
  /// Component c of a difference of two positions, to the nearest periodic image.
  double nearest(int c, double difference) const {
    return period_[c] > 0 ? difference - period_[c] * std::rint(difference / period_[c]) : difference;
  }
  /// Period in each direction [m]; 0 where not periodic.
  const std::array<double, 3>& period() const { return period_; }
  std::size_t bytes() const;
  std::size_t pairs() const { return pairs_; }
  /// Places of the list, fillers among them: the size of what is stored per pair.
  std::size_t slots() const { return j_.size(); }

  /// Sum over the neighbours of i of f(pairs), an array of N registers.
  template <int D, int N, class F>
  std::array<double, N> sum_row(Index i, F&& f) const {
    std::array<Lanes, N> all;
    all.fill(Lanes(0));
    for (Index k = start_[i]; k < start_[i + 1]; k += kLaneCount) {
      const std::array<Lanes, N> some = f(lanes<D>(k));
      for (int n = 0; n < N; ++n) all[n] += some[n];
    }
    std::array<double, N> out;
    for (int n = 0; n < N; ++n) out[n] = sum(all[n]);
    return out;
  }

  /// Calls f(pairs) for registers of neighbours of i, for an f that writes to the places pairs.k and
  /// following.
  template <int D, class F>
  void for_lanes(Index i, F&& f) const {
    for (Index k = start_[i]; k < start_[i + 1]; k += kLaneCount) f(lanes<D>(k));
  }

  /// Calls f(pair) for the neighbours of i, in order.
  template <int D, class F>
  void for_row(Index i, F&& f) const {
    for (Index k = begin(i); k < end(i); ++k) f(at<D>(k));
  }

  template <int D>
  Pair<D> at(Index k) const {
    Pair<D> p;
    p.j = j_[k];
    p.k = k;
    for (int c = 0; c < D; ++c) p.x[c] = dx_[c][k];
    p.w = w_[k];
    p.f = f_[k];
    return p;
  }

  template <int D>
  PairLanes<D> lanes(Index k) const {
    PairLanes<D> p;
    p.j = j_.data() + k;
    p.k = k;
    for (int c = 0; c < D; ++c) p.x[c] = load(dx_[c].data() + k);
    p.w = load(w_.data() + k);
    p.f = load(f_.data() + k);
    return p;
  }

 private:
  /// Rows of some consecutive cells and what their search needs. Distances are tested in single precision,
  /// relative to the cell, with a margin: pairs beyond the support have weight 0 and do no harm.
  struct Block {
    std::vector<Index> row, count;
    std::vector<Index> entries;  ///< neighbours of the rows, one after the other; `used` of them
    std::size_t used = 0;
    std::vector<Index> candidate;
    std::array<std::vector<float>, 3> candidate_x;
    std::vector<float> candidate_h;
  };
  template <int D>
  void gather_candidates(const Patch& patch, const CellGrid& grid, Index cell, Block& block) const;
  template <int D>
  void search_row(const Patch& patch, Index i, Index origin, double skin, Block& block) const;
  void refresh_with(const Patch& patch, KernelType kernel, const std::vector<Index>* some);
  template <int D, class Kernel, bool Periodic>
  void refresh_rows(const Patch& patch, const std::vector<Index>* some);
  void clear_blocks();
  /// Finds the wanted rows of these cells, `block_cells` of them a task.
  void search(const Patch& patch, const CellGrid& grid, double skin, std::span<const Index> cells,
              Index block_cells);
  void place_rows(Index begin, Index end);
  void copy_blocks(const Patch& patch);

  int dim_ = 3;
  std::array<double, 3> period_{};
  std::vector<Index> start_{0}, count_, j_;
  std::size_t pairs_ = 0;
  std::array<std::vector<float>, 3> dx_;
  std::vector<float> w_, f_;
  std::vector<std::uint8_t> next_to_melt_, next_to_wall_, wanted_;
  std::vector<Block> blocks_;
};

}  // namespace meltray::sph
