// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "laser/cloud_selection.hpp"
#include "laser/grid_filter.hpp"

namespace meltray::laser {

/// Smoothed volume fraction of metal, 1 inside and 0 outside, on a regular grid. Each particle spreads its
/// volume over the nodes with cubic B-splines; the node values, filtered, are in turn the coefficients of a
/// cubic B-spline, which is the field. So value and gradient are smooth and consistent, the lattice of the
/// particles leaves no trace, and a half-space of particles has the value 1/2 half a spacing above its last
/// layer, by symmetry. The smoothing is close to a Gaussian of deviation 0.86 spacings.
///
/// So wide a kernel closes a slit narrower than 1.2 spacings and bends the walls of a wider one. In slits the
/// field is therefore lowered by a multiple of what it exceeds that of a sharper kernel, deviation 0.54
/// spacings: unsharp masking of voids alone. Flat walls, drops and films keep their field.
///
/// Nodes are in single precision: 1e-7 of a spacing is far below what one particle more or less moves.
class SmoothedField {
 public:
  /// The cells cover `extent`; their corners are multiples of the step, so a region that moves with the
  /// beam sees the same grid.
  SmoothedField(const CloudSelection& cloud, double spacing, const Box& extent);

  static constexpr double kStep = 2.0 / 3;  ///< of the grid, in spacings

  using Cell = Nodes;
  const Cell& cells() const { return cells_; }
  double step() const { return step_; }
  Vec3 corner(const Cell& c) const {
    return origin_ +
           step_ * Vec3(static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2]));
  }
  /// Value at a cell corner; indices 0 to cells().
  double at_corner(std::ptrdiff_t i, std::ptrdiff_t j, std::ptrdiff_t k) const {
    return corner_value_[node({i, j, k})];
  }

  struct Sample {
    double value;
    Vec3 gradient;  ///< per step
  };
  /// Field at `local` in [0, 1]^3 of a cell.
  Sample sample(const Cell& cell, const Vec3& local) const;
  /// True where the particles around are liquid rather than solid.
  bool liquid(const Cell& cell, const Vec3& local) const;

 private:
  /// Particles by the row of cells along x that they lie in: row r holds those numbered order[start[r]] to
  /// order[start[r + 1] - 1]. Rows go from the one that ends below the first row of nodes; `planes` along z.
  struct Rows {
    std::ptrdiff_t along_y = 0, planes = 0;
    std::vector<std::size_t> start, order;
  };
  Rows sort(const CloudSelection& cloud) const;
  void spread(const CloudSelection& cloud, const Rows& rows, float share);
  void mark_phases(const CloudSelection& cloud, const Rows& rows);
  /// Turns what the particles have spread into the coefficients of the field.
  void open_slits();
  void evaluate_corners();
  template <class F>
  void for_rows(const std::vector<float>& nodes, const Cell& cell, F&& f) const;
  std::size_t node(const Cell& c) const {
    return static_cast<std::size_t>(((c[2] + kPad[2]) * nodes_[1] + c[1] + kPad[1]) * nodes_[0] + c[0] +
                                    kPad[0]);
  }

  // Nodes beyond the cells: one that vertices reach and what the filters reach beyond it, less one, whose
  // weight is small. Along x three more, which lack the particles beyond the rim.
  static constexpr Cell kPad = {6, 4, 4};

  double step_;
  Vec3 origin_;
  Cell cells_, nodes_;
  // By node: spline coefficients; liquid less solid particles, empty without liquid.
  std::vector<float> metal_, excess_;
  std::vector<float> corner_value_;
};

}  // namespace meltray::laser
