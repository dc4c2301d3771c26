// SPDX-License-Identifier: MIT
#include "laser/smoothed_field.hpp"

#include <algorithm>
#include <cmath>

#include "meltray/core/errors.hpp"
#include "meltray/core/parallel.hpp"

namespace meltray::laser {
namespace {

// Nodes beyond the cells: one that the spline of the outermost cell reaches, and what particles beyond it
// need to spread without a check of bounds.
constexpr std::ptrdiff_t kPad = 4;
constexpr double kMaxNodes = 2e8;

using Weights = std::array<double, 4>;

/// Cubic B-spline weights of the nodes floor(u) - 1 ... floor(u) + 2; t = u - floor(u).
Weights spline(double t) {
  const double s = 1 - t;
  return {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6,
          t * t * t / 6};
}

Weights spline_derivative(double t) {
  const double s = 1 - t;
  return {-s * s / 2, (3 * t * t - 4 * t) / 2, (4 * s - 3 * s * s) / 2, t * t / 2};
}

/// A particle with the weights of its 4 x 4 x 4 nodes.
struct Splat {
  std::array<Weights, 3> w;
  std::ptrdiff_t first_x;  // node of w[0][0]
  bool liquid;
};

/// Adds to out[0 .. n) the nodes from `in` on, weighed with their 27 neighbours by `w` along every axis.
void filter_row(const double* in, const SmoothedField::Cell& nodes, const std::array<double, 3>& w,
                std::ptrdiff_t n, double* out) {
  for (std::ptrdiff_t b = 0; b < 3; ++b) {
    for (std::ptrdiff_t a = 0; a < 3; ++a) {
      const double across = w[static_cast<std::size_t>(a)] * w[static_cast<std::size_t>(b)];
      const double* m = in + ((b - 1) * nodes[1] + a - 1) * nodes[0];
      for (std::ptrdiff_t i = 0; i < n; ++i)
        out[i] += across * (w[0] * m[i - 1] + w[1] * m[i] + w[2] * m[i + 1]);
    }
  }
}

}  // namespace

SmoothedField::SmoothedField(const CloudSelection& cloud, double particle_volume, const Box& extent,
                             double step)
    : step_(step) {
  double count = 1;
  for (int a = 0; a < 3; ++a) {
    const double low = std::floor(extent.min[a] / step), high = std::ceil(extent.max[a] / step);
    count *= high - low + 1 + 2 * kPad;
    if (!(count < kMaxNodes))
      throw NumericalFailure("surface mesh: the region around the beam is too large for the spacing");
    origin_[a] = low * step;
    cells_[a] = static_cast<std::ptrdiff_t>(high - low);
    nodes_[a] = cells_[a] + 1 + 2 * kPad;
  }
  spread(cloud, particle_volume / (step * step * step));
  evaluate_corners();
  smooth();
}

void SmoothedField::spread(const CloudSelection& cloud, double share) {
  // Particles sorted by their row of cells along x; every row of nodes then gathers from 16 such rows.
  const std::size_t rows = static_cast<std::size_t>(nodes_[1] * nodes_[2]);
  const std::size_t n = cloud.position.size();
  constexpr std::size_t kOutside = ~std::size_t{0};
  std::vector<std::size_t> row_of(n), start(rows + 1, 0);
  bool any_liquid = false;
  for (std::size_t p = 0; p < n; ++p) {
    std::array<std::ptrdiff_t, 3> c;
    bool reaches = true;
    for (int a = 0; a < 3; ++a) {
      const double u = std::floor((cloud.position[p][a] - origin_[a]) / step_) + kPad;
      reaches &= u >= 1 && u <= static_cast<double>(nodes_[a] - 3);
      c[a] = reaches ? static_cast<std::ptrdiff_t>(u) : 0;
    }
    row_of[p] = reaches ? static_cast<std::size_t>(c[2] * nodes_[1] + c[1]) : kOutside;
    if (!reaches) continue;
    ++start[row_of[p] + 1];
    any_liquid |= cloud.liquid[p] != 0;
  }
  for (std::size_t r = 0; r < rows; ++r) start[r + 1] += start[r];
  std::vector<std::size_t> cursor(start.begin(), start.end() - 1), order(start.back());
  for (std::size_t p = 0; p < n; ++p)
    if (row_of[p] != kOutside) order[cursor[row_of[p]]++] = p;

  std::vector<Splat> splats(order.size());
  parallel_for(static_cast<std::ptrdiff_t>(order.size()), [&](std::ptrdiff_t q) {
    const std::size_t p = order[static_cast<std::size_t>(q)];
    Splat& s = splats[static_cast<std::size_t>(q)];
    for (int a = 0; a < 3; ++a) {
      const double u = (cloud.position[p][a] - origin_[a]) / step_;
      const double base = std::floor(u);
      s.w[static_cast<std::size_t>(a)] = spline(u - base);
      if (a == 0) s.first_x = static_cast<std::ptrdiff_t>(base) + kPad - 1;
    }
    for (double& w : s.w[0]) w *= share;
    s.liquid = cloud.liquid[p] != 0;
  });

  metal_.assign(rows * static_cast<std::size_t>(nodes_[0]), 0.0);
  if (any_liquid) liquid_.assign(metal_.size(), 0.0);
  parallel_for(static_cast<std::ptrdiff_t>(rows), [&](std::ptrdiff_t row) {
    const std::ptrdiff_t j = row % nodes_[1], k = row / nodes_[1];
    double* metal = metal_.data() + row * nodes_[0];
    double* liquid = any_liquid ? liquid_.data() + row * nodes_[0] : nullptr;
    for (std::ptrdiff_t b = 3; b >= 0; --b) {
      for (std::ptrdiff_t a = 3; a >= 0; --a) {
        const std::ptrdiff_t jp = j + 1 - a, kp = k + 1 - b;
        if (jp < 0 || kp < 0 || jp >= nodes_[1] || kp >= nodes_[2]) continue;
        const std::size_t from = static_cast<std::size_t>(kp * nodes_[1] + jp);
        for (std::size_t q = start[from]; q < start[from + 1]; ++q) {
          const Splat& s = splats[q];
          const double w = s.w[1][static_cast<std::size_t>(a)] * s.w[2][static_cast<std::size_t>(b)];
          for (std::size_t i = 0; i < 4; ++i)
            metal[s.first_x + static_cast<std::ptrdiff_t>(i)] += w * s.w[0][i];
          if (s.liquid)
            for (std::size_t i = 0; i < 4; ++i)
              liquid[s.first_x + static_cast<std::ptrdiff_t>(i)] += w * s.w[0][i];
        }
      }
    }
  });
}

void SmoothedField::evaluate_corners() {
  // A cubic spline at a node weighs the coefficients there and beside it 1/6, 2/3, 1/6.
  const std::ptrdiff_t nx = cells_[0] + 1, ny = cells_[1] + 1, nz = cells_[2] + 1;
  corner_value_.assign(static_cast<std::size_t>(nx * ny * nz), 0.0);
  parallel_for(ny * nz, [&](std::ptrdiff_t row) {
    const std::ptrdiff_t node = ((row / ny + kPad) * nodes_[1] + row % ny + kPad) * nodes_[0] + kPad;
    filter_row(metal_.data() + node, nodes_, {1.0 / 6, 2.0 / 3, 1.0 / 6}, nx,
               corner_value_.data() + row * nx);
  });
}

void SmoothedField::smooth() {
  // The nodes that vertices in the cells reach: one beyond the corners.
  const std::ptrdiff_t nx = cells_[0] + 3, ny = cells_[1] + 3, nz = cells_[2] + 3;
  smoothed_.assign(metal_.size(), 0.0);
  parallel_for(ny * nz, [&](std::ptrdiff_t row) {
    const std::ptrdiff_t node =
        ((row / ny + kPad - 1) * nodes_[1] + row % ny + kPad - 1) * nodes_[0] + kPad - 1;
    filter_row(metal_.data() + node, nodes_, {0.25, 0.5, 0.25}, nx, smoothed_.data() + node);
  });
}

SmoothedField::Sample SmoothedField::evaluate(const std::vector<double>& coefficients, const Cell& cell,
                                              const Vec3& local) const {
  std::array<Weights, 3> w, d;
  for (std::size_t a = 0; a < 3; ++a) {
    w[a] = spline(local[static_cast<int>(a)]);
    d[a] = spline_derivative(local[static_cast<int>(a)]);
  }
  Sample s{0, Vec3::Zero()};
  const double* corner = coefficients.data() +
                         ((cell[2] + kPad - 1) * nodes_[1] + cell[1] + kPad - 1) * nodes_[0] + cell[0] +
                         kPad - 1;
  for (std::size_t b = 0; b < 4; ++b) {
    for (std::size_t a = 0; a < 4; ++a) {
      const double* m =
          corner + (static_cast<std::ptrdiff_t>(b) * nodes_[1] + static_cast<std::ptrdiff_t>(a)) * nodes_[0];
      double value = 0, slope = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        value += w[0][i] * m[i];
        slope += d[0][i] * m[i];
      }
      s.value += w[1][a] * w[2][b] * value;
      s.gradient += Vec3(w[1][a] * w[2][b] * slope, d[1][a] * w[2][b] * value, w[1][a] * d[2][b] * value);
    }
  }
  return s;
}

}  // namespace meltray::laser
