// SPDX-License-Identifier: MIT
#include "laser/smoothed_field.hpp"

#include <algorithm>
#include <cmath>

#include "meltray/core/errors.hpp"
#include "meltray/core/parallel.hpp"

namespace meltray::laser {
namespace {

constexpr double kMaxNodes = 2e8;

// Smoothing by (1/4, 1/2, 1/4), applied so many times. The two splines have a variance of 2/3 steps squared;
// each time adds 1/2.
constexpr int kSharpToSoft = 2, kSoftToWide = 2;
// A slit is where the widely smoothed field is above its value 1/2 at a flat wall and, as in any hollow,
// above the soft one: from none to full. Near 1 it is but the disorder of dense metal.
constexpr float kFlat = 0.5F, kSurrounded = 0.7F, kHollow = 0.05F, kDisorder = 0.8F, kDense = 0.9F;
// Chosen, as the limits above, so that wedges of 15 to 45 degrees are right as close to the tip as the two
// walls can be told apart, and walls of disordered particles stay as smooth as without.
constexpr float kSharpening = 2.25F;

using Weights = std::array<float, 4>;

/// Cubic B-spline weights of the nodes floor(u) - 1 ... floor(u) + 2; t = u - floor(u).
Weights spline(float t) {
  const float s = 1 - t;
  return {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6,
          t * t * t / 6};
}

Weights spline_derivative(float t) {
  const float s = 1 - t;
  return {-s * s / 2, (3 * t * t - 4 * t) / 2, (4 * s - 3 * s * s) / 2, t * t / 2};
}

/// A particle with the weights of its 4 x 4 x 4 nodes.
struct Splat {
  Weights x, y, z;
  std::int32_t first_x;  // node of x[0]
};

float ramp(float x, float none, float full) {
  return std::clamp((x - none) / (full - none), 0.0F, 1.0F);
}

/// 0 at flat walls, outside convex metal and in dense metal, 1 in slits.
float slit(float soft, float wide) {
  return ramp(wide, kFlat, kSurrounded) * ramp(wide - soft, 0, kHollow) * ramp(wide, kDense, kDisorder);
}

}  // namespace

SmoothedField::SmoothedField(const CloudSelection& cloud, double spacing, const Box& extent)
    : step_(kStep * spacing) {
  double count = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    const double low = std::floor(extent.min[axis] / step_), high = std::ceil(extent.max[axis] / step_);
    const double pads = static_cast<double>(2 * kPad[a]);
    count *= high - low + 1 + pads;
    if (!(count < kMaxNodes))
      throw NumericalFailure("surface mesh: the region around the beam is too large for the spacing");
    origin_[axis] = low * step_;
    cells_[a] = static_cast<std::ptrdiff_t>(high - low);
    nodes_[a] = cells_[a] + 1 + 2 * kPad[a];
  }
  spread(cloud, static_cast<float>(1 / (kStep * kStep * kStep)));
  mark_phases(cloud);
  open_slits();
  evaluate_corners();
}

void SmoothedField::spread(const CloudSelection& cloud, float share) {
  // Particles sorted by their row of cells along x; every row of nodes then gathers from 16 such rows. Along
  // x only particles all of whose nodes exist take part, which is why the pad is wider there.
  const std::ptrdiff_t cells_y = nodes_[1] + 3;  // rows from the one that ends below the first row of nodes
  const std::size_t rows = static_cast<std::size_t>(cells_y * (nodes_[2] + 3));
  const std::size_t n = cloud.position.size();
  constexpr std::size_t kOutside = ~std::size_t{0};
  std::vector<std::size_t> row_of(n), start(rows + 1, 0);
  parallel_for(static_cast<std::ptrdiff_t>(n), [&](std::ptrdiff_t q) {
    const auto p = static_cast<std::size_t>(q);
    const Vec3 u = ((cloud.position[p] - origin_) / step_).array().floor();
    const std::ptrdiff_t x = static_cast<std::ptrdiff_t>(u.x()) + kPad[0],
                         y = static_cast<std::ptrdiff_t>(u.y()) + kPad[1] + 2,
                         z = static_cast<std::ptrdiff_t>(u.z()) + kPad[2] + 2;
    const bool reaches = x >= 1 && x <= nodes_[0] - 3 && y >= 0 && y < cells_y && z >= 0 && z < nodes_[2] + 3;
    row_of[p] = reaches ? static_cast<std::size_t>(z * cells_y + y) : kOutside;
  });
  for (std::size_t p = 0; p < n; ++p)
    if (row_of[p] != kOutside) ++start[row_of[p] + 1];
  for (std::size_t r = 0; r < rows; ++r) start[r + 1] += start[r];
  std::vector<std::size_t> cursor(start.begin(), start.end() - 1), order(start.back());
  for (std::size_t p = 0; p < n; ++p)
    if (row_of[p] != kOutside) order[cursor[row_of[p]]++] = p;

  std::vector<Splat> splats(order.size());
  parallel_for(static_cast<std::ptrdiff_t>(order.size()), [&](std::ptrdiff_t q) {
    const std::size_t p = order[static_cast<std::size_t>(q)];
    Splat& s = splats[static_cast<std::size_t>(q)];
    const Vec3 u = (cloud.position[p] - origin_) / step_;
    const Vec3 base = u.array().floor();
    const Eigen::Vector3f t = (u - base).cast<float>();
    s.x = spline(t.x());
    for (float& w : s.x) w *= share;
    s.y = spline(t.y());
    s.z = spline(t.z());
    s.first_x = static_cast<std::int32_t>(base.x()) + static_cast<std::int32_t>(kPad[0]) - 1;
  });

  metal_.assign(static_cast<std::size_t>(nodes_[0] * nodes_[1] * nodes_[2]), 0.0F);
  parallel_for(nodes_[1] * nodes_[2], [&](std::ptrdiff_t row) {
    const std::ptrdiff_t j = row % nodes_[1], k = row / nodes_[1];
    float* metal = metal_.data() + row * nodes_[0];
    for (std::ptrdiff_t b = 3; b >= 0; --b) {
      for (std::ptrdiff_t a = 3; a >= 0; --a) {
        const std::size_t from = static_cast<std::size_t>((k + 3 - b) * cells_y + j + 3 - a);
        for (std::size_t q = start[from]; q < start[from + 1]; ++q) {
          const Splat& s = splats[q];
          const float w = s.y[static_cast<std::size_t>(a)] * s.z[static_cast<std::size_t>(b)];
          for (std::size_t i = 0; i < 4; ++i) metal[s.first_x + static_cast<std::ptrdiff_t>(i)] += w * s.x[i];
        }
      }
    }
  });
}

void SmoothedField::mark_phases(const CloudSelection& cloud) {
  if (std::none_of(cloud.liquid.begin(), cloud.liquid.end(), [](std::uint8_t l) { return l != 0; })) return;
  excess_.assign(metal_.size(), 0.0F);
  for (std::size_t p = 0; p < cloud.position.size(); ++p) {
    const Vec3 u = (cloud.position[p] - origin_) / step_;
    Cell c;
    bool inside = true;
    for (std::size_t a = 0; a < 3; ++a) {
      c[a] = static_cast<std::ptrdiff_t>(std::floor(u[static_cast<int>(a)] + 0.5));
      inside &= c[a] >= -kPad[a] && c[a] <= cells_[a] + kPad[a];
    }
    if (inside) excess_[node(c)] += cloud.liquid[p] ? 1.0F : -1.0F;
  }
}

void SmoothedField::open_slits() {
  corner_value_ = metal_;  // sharp
  const float* sharp = corner_value_.data();
  filter(metal_, nodes_, binomial(kSharpToSoft));
  std::vector<float> wide = metal_;
  filter(wide, nodes_, binomial(kSoftToWide));
  parallel_for(static_cast<std::ptrdiff_t>(metal_.size()), [&](std::ptrdiff_t p) {
    const auto q = static_cast<std::size_t>(p);
    if (wide[q] > kFlat && wide[q] > metal_[q] && metal_[q] > sharp[q])
      metal_[q] -= kSharpening * slit(metal_[q], wide[q]) * (metal_[q] - sharp[q]);
  });
}

void SmoothedField::evaluate_corners() {
  // A cubic spline at a node weighs the coefficients there and beside it 1/6, 2/3, 1/6.
  corner_value_ = metal_;
  filter(corner_value_, nodes_, {2.0F / 3, 1.0F / 6});
}

bool SmoothedField::liquid(const Cell& cell, const Vec3& local) const {
  return !excess_.empty() && evaluate(excess_, cell, local).value > 0;
}

SmoothedField::Sample SmoothedField::evaluate(const std::vector<float>& coefficients, const Cell& cell,
                                              const Vec3& local) const {
  std::array<Weights, 3> w, d;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto t = static_cast<float>(local[static_cast<int>(a)]);
    w[a] = spline(t);
    d[a] = spline_derivative(t);
  }
  float field = 0;
  Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
  const float* corner = coefficients.data() + node({cell[0] - 1, cell[1] - 1, cell[2] - 1});
  for (std::size_t b = 0; b < 4; ++b) {
    for (std::size_t a = 0; a < 4; ++a) {
      const float* m =
          corner + (static_cast<std::ptrdiff_t>(b) * nodes_[1] + static_cast<std::ptrdiff_t>(a)) * nodes_[0];
      float value = 0, slope = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        value += w[0][i] * m[i];
        slope += d[0][i] * m[i];
      }
      field += w[1][a] * w[2][b] * value;
      gradient +=
          Eigen::Vector3f(w[1][a] * w[2][b] * slope, d[1][a] * w[2][b] * value, w[1][a] * d[2][b] * value);
    }
  }
  return {field, gradient.cast<double>()};
}

}  // namespace meltray::laser
