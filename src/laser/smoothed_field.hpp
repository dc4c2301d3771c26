// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "laser/cloud_selection.hpp"

namespace meltray::laser {

/// Smoothed volume fraction of metal, 1 inside and 0 outside. Each particle spreads its volume over the nodes
/// of a regular grid with cubic B-splines; the node values are in turn the coefficients of a cubic B-spline,
/// which is the field. So value and gradient are smooth, consistent and cheap, the lattice of the particles
/// leaves no trace (both splines sum to one), and a half-space of particles has the value 1/2 half a spacing
/// above its last layer, by symmetry. The smoothing is close to a Gaussian of deviation sqrt(2/3) steps.
class SmoothedField {
 public:
  /// The cells cover `extent`; their corners are multiples of `step`, so a region that moves with the beam
  /// sees the same grid.
  SmoothedField(const CloudSelection& cloud, double particle_volume, const Box& extent, double step);

  using Cell = std::array<std::ptrdiff_t, 3>;
  const Cell& cells() const { return cells_; }
  double step() const { return step_; }
  Vec3 corner(const Cell& c) const {
    return origin_ +
           step_ * Vec3(static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2]));
  }
  /// Value at a cell corner; indices 0 to cells().
  double at_corner(std::ptrdiff_t i, std::ptrdiff_t j, std::ptrdiff_t k) const {
    return corner_value_[static_cast<std::size_t>((k * (cells_[1] + 1) + j) * (cells_[0] + 1) + i)];
  }

  struct Sample {
    double value;
    Vec3 gradient;  ///< per step
  };
  /// Field at `local` in [0, 1]^3 of a cell.
  Sample sample(const Cell& cell, const Vec3& local) const { return evaluate(metal_, cell, local); }
  /// Smoothed volume fraction of liquid metal.
  double liquid(const Cell& cell, const Vec3& local) const {
    return liquid_.empty() ? 0 : evaluate(liquid_, cell, local).value;
  }
  /// Gradient per step of the field smoothed once more by (1/4, 1/2, 1/4) along every axis. The disorder of
  /// the particles tilts the isosurface by some degrees; light feels the mean slope of a few spacings.
  Vec3 smooth_gradient(const Cell& cell, const Vec3& local) const {
    return evaluate(smoothed_, cell, local).gradient;
  }

 private:
  void spread(const CloudSelection& cloud, double share);
  void evaluate_corners();
  void smooth();
  /// Value and gradient of the spline with the given coefficients.
  Sample evaluate(const std::vector<double>& coefficients, const Cell& cell, const Vec3& local) const;

  double step_;
  Vec3 origin_;
  Cell cells_, nodes_;
  // Spline coefficients by node; liquid_ stays empty without liquid particles.
  std::vector<double> metal_, liquid_, smoothed_, corner_value_;
};

}  // namespace meltray::laser
