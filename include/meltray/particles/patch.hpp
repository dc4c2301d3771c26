// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "meltray/particles/cell_grid.hpp"
#include "meltray/particles/particles.hpp"

namespace meltray {

/// The particles that take part in a step, copied out of the store and sorted by cell: everything else sleeps
/// and costs nothing. Patch indices are valid until the next selection.
struct Patch {
  int dim = 3;
  std::vector<Index> global;      ///< patch index -> particle
  std::vector<Index> cell_start;  ///< first patch index of each grid cell (cells() + 1 entries)
  std::vector<Index> cells;       ///< grid cells that are in the patch, ascending; all others are empty
  Components x, v;
  std::vector<double> h, mass, smoothing, pressure;
  std::vector<double> density;       ///< empty where the store has none
  SymmetricComponents stress;        ///< deviatoric stress S [Pa]; empty where the store has none
  std::vector<std::uint8_t> liquid;  ///< 1 = liquid
  std::vector<std::uint8_t> wall;    ///< 0, or 1 + index of the box face a dummy belongs to

  /// Elastic::none, free or clamped; empty in scenes without elastic solid. Set by mark_elastic().
  std::vector<std::uint8_t> elastic;

  Index size() const { return static_cast<Index>(global.size()); }
  std::size_t bytes() const;
};

/// What a particle is to the elastic solid: melt, wall or solid that rests; solid that moves; solid that is
/// held at its place but takes stress.
enum class Elastic : std::uint8_t { none = 0, free = 1, clamped = 2 };

/// Keeps track of which particle sits in which cell and selects patches.
class PatchSelector {
 public:
  PatchSelector() = default;
  PatchSelector(const CellGrid& grid, const Particles& particles);

  const CellGrid& grid() const { return grid_; }
  /// A particle has melted or solidified: it leaves or enters the cells of particles that do not move.
  void melted(const Particles& particles, Index i);
  void solidified(const Particles& particles, Index i);

  /// Every particle of the scene.
  void select_all(const Particles& particles, Patch& patch);
  /// Particles within `reach` widths of a cell of a liquid particle, and within one of one of `also`. With
  /// two, rows of liquid particles, of the solid ones next to them and of `also` have all their neighbours in
  /// the patch.
  void select_near_melt(const Particles& particles, std::span<const Index> also, Patch& patch,
                        Index reach = 2);

  /// Which solid of the patch is elastic: all of it after select_all(), else that within `distance` [m] of a
  /// liquid particle; the patch then has to reach one cell farther. Solid that has moved and is no longer
  /// among it comes to rest where it is.
  void mark_elastic(Particles& particles, Patch& patch, double distance);
  Index cells_across(double distance) const;
  /// Elastic solid has moved in the patch but not yet in the store: it changes cells. Call before
  /// write_back().
  void follow(const Particles& particles, const Patch& patch);

  /// Particles in the cells of `centres` and the cells next to them.
  void select_around(const Particles& particles, std::span<const Index> centres, Patch& patch);
  /// Resting and moving particles inside a box, by index.
  void gather(const Particles& particles, const Vec3& min, const Vec3& max, std::vector<Index>& out) const;

  const std::vector<Index>& moving() const { return moving_; }
  std::size_t bytes() const;
  /// Calls f(i) for resting particles (no dummies) within `radius` of a point; at most one cell wide.
  template <class F>
  void for_resting_near(const Particles& p, const Vec3& point, double radius, F&& f) const {
    grid_.for_box(point - Vec3::Constant(radius), point + Vec3::Constant(radius), [&](Index cell) {
      for (Index i : resting_[cell]) {
        double r2 = 0;
        for (int c = 0; c < p.dim; ++c) r2 += (p.x[c][i] - point[c]) * (p.x[c][i] - point[c]);
        if (r2 < radius * radius && !p.is_wall(i)) f(i);
      }
    });
  }

 private:
  void unmark();
  void mark(Index cell);
  void mark_block(Index cell);
  void mark_near(const Particles& particles, Index cell, Index reach);
  void fill(const Particles& particles, Patch& patch);
  void sort_moving(const Particles& particles);
  bool near_melt(const Patch& patch, Index k, Index cell, double distance) const;

  CellGrid grid_;
  std::vector<std::vector<Index>> resting_;  ///< solid and wall particles by cell, ascending
  std::vector<Index> moving_;                ///< liquid particles, ascending
  std::vector<std::uint8_t> core_, marked_;  ///< per cell; core_ empty: every cell
  std::vector<Index> marked_cells_;
  std::vector<std::uint8_t> moves_;  ///< per particle, of mark_elastic()
  std::vector<Index> moving_cell_, moving_sorted_, moving_start_;
};

/// Copies the fields of the patch's particles anew from the store; the selection stays.
void reload(const Particles& particles, Patch& patch);

/// Copies the fields that a step changes from the patch back to the store.
void write_back(const Patch& patch, Particles& particles);

}  // namespace meltray
