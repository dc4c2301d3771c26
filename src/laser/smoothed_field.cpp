// SPDX-License-Identifier: MIT
#include "laser/smoothed_field.hpp"

#include <algorithm>
#include <cmath>
#include <experimental/simd>

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

namespace stdx = std::experimental;
using Weights = std::array<float, 4>;
/// Four nodes that follow one another along x.
using Quad = stdx::simd<float, stdx::simd_abi::deduce_t<float, 4>>;

Quad load(const float* four) {
  return Quad(four, stdx::element_aligned);
}

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

/// A particle with the weights of its 4 x 4 x 4 nodes: one line of the cache.
struct alignas(64) Splat {
  Weights x, y, z;
  std::int32_t first_x;  // node of x[0]
};

/// Sums over one row of nodes. Particles side by side share some of their nodes: if the next one read four
/// nodes of which the last has just written two, it would wait for the write. Four lines, each for the
/// particles whose first node is the same modulo four, are read as they are written, or not at all.
class RowSums {
 public:
  explicit RowSums(std::ptrdiff_t nodes) {
    for (auto& line : line_) line.resize(static_cast<std::size_t>(nodes) + 2 * kShift);
  }
  void clear() {
    for (auto& line : line_) std::fill(line.begin(), line.end(), 0.0F);
  }
  void add(const Splat& s, float weight) {
    const auto first = static_cast<std::size_t>(s.first_x), offset = first % 4;
    float* const four = line_[offset].data() + (first - offset + kShift);
    (load(four) + weight * load(s.x.data())).copy_to(four, stdx::element_aligned);
  }
  void write(float* row, std::ptrdiff_t nodes) const {
    std::fill_n(row, nodes, 0.0F);
    for (std::size_t d = 0; d < 4; ++d) {
      const float* const line = line_[d].data() + (kShift - d);
      for (std::ptrdiff_t i = 0; i < nodes; ++i) row[i] += line[i];
    }
  }

 private:
  static constexpr std::size_t kShift = 4;
  std::array<std::vector<float>, 4> line_;  // line d, entry kShift + k: node k + d
};

float ramp(float x, float none, float full) {
  return std::max(std::min((x - none) / (full - none), 1.0F), 0.0F);
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
  const Rows rows = sort(cloud);
  spread(cloud, rows, static_cast<float>(1 / (kStep * kStep * kStep)));
  mark_phases(cloud, rows);
  open_slits();
  evaluate_corners();
}

/// Along x only particles all of whose nodes exist take part, which is why the pad is wider there.
SmoothedField::Rows SmoothedField::sort(const CloudSelection& cloud) const {
  Rows rows;
  rows.along_y = nodes_[1] + 3;
  rows.planes = nodes_[2] + 3;
  const std::size_t n = cloud.position.size(), count = static_cast<std::size_t>(rows.along_y * rows.planes);
  constexpr std::size_t kOutside = ~std::size_t{0};
  std::vector<std::size_t> row_of(n);
  parallel_for(static_cast<std::ptrdiff_t>(n), [&](std::ptrdiff_t q) {
    const auto p = static_cast<std::size_t>(q);
    const Vec3 u = ((cloud.position[p] - origin_) / step_).array().floor();
    const std::ptrdiff_t x = static_cast<std::ptrdiff_t>(u.x()) + kPad[0],
                         y = static_cast<std::ptrdiff_t>(u.y()) + kPad[1] + 2,
                         z = static_cast<std::ptrdiff_t>(u.z()) + kPad[2] + 2;
    const bool reaches =
        x >= 1 && x <= nodes_[0] - 3 && y >= 0 && y < rows.along_y && z >= 0 && z < rows.planes;
    row_of[p] = reaches ? static_cast<std::size_t>(z * rows.along_y + y) : kOutside;
  });
  rows.start.assign(count + 1, 0);
  for (std::size_t p = 0; p < n; ++p)
    if (row_of[p] != kOutside) ++rows.start[row_of[p] + 1];
  for (std::size_t r = 0; r < count; ++r) rows.start[r + 1] += rows.start[r];
  std::vector<std::size_t> cursor(rows.start.begin(), rows.start.end() - 1);
  rows.order.resize(rows.start.back());
  for (std::size_t p = 0; p < n; ++p)
    if (row_of[p] != kOutside) rows.order[cursor[row_of[p]]++] = p;
  return rows;
}

/// Every row of nodes gathers from the 16 rows of cells around it.
void SmoothedField::spread(const CloudSelection& cloud, const Rows& rows, float share) {
  std::vector<Splat> splats(rows.order.size());
  parallel_for(static_cast<std::ptrdiff_t>(splats.size()), [&](std::ptrdiff_t q) {
    Splat& s = splats[static_cast<std::size_t>(q)];
    const Vec3 u = (cloud.position[rows.order[static_cast<std::size_t>(q)]] - origin_) / step_;
    const Vec3 base = u.array().floor();
    const Eigen::Vector3f t = (u - base).cast<float>();
    s.x = spline(t.x());
    for (float& w : s.x) w *= share;
    s.y = spline(t.y());
    s.z = spline(t.z());
    s.first_x = static_cast<std::int32_t>(base.x()) + static_cast<std::int32_t>(kPad[0]) - 1;
  });

  metal_.resize(static_cast<std::size_t>(nodes_[0] * nodes_[1] * nodes_[2]));
#pragma omp parallel
  {
    RowSums sums(nodes_[0]);
#pragma omp for schedule(dynamic, 16)
    for (std::ptrdiff_t row = 0; row < nodes_[1] * nodes_[2]; ++row) {
      const std::ptrdiff_t j = row % nodes_[1], k = row / nodes_[1];
      sums.clear();
      for (std::ptrdiff_t b = 3; b >= 0; --b)
        for (std::ptrdiff_t a = 3; a >= 0; --a) {
          const std::size_t from = static_cast<std::size_t>((k + 3 - b) * rows.along_y + j + 3 - a);
          for (std::size_t q = rows.start[from]; q < rows.start[from + 1]; ++q)
            sums.add(splats[q],
                     splats[q].y[static_cast<std::size_t>(a)] * splats[q].z[static_cast<std::size_t>(b)]);
        }
      sums.write(metal_.data() + row * nodes_[0], nodes_[0]);
    }
  }
}

void SmoothedField::mark_phases(const CloudSelection& cloud, const Rows& rows) {
  if (std::none_of(cloud.liquid.begin(), cloud.liquid.end(), [](std::uint8_t l) { return l != 0; })) return;
  excess_.assign(metal_.size(), 0.0F);
  const auto mark = [&](std::size_t p) {
    const Vec3 u = (cloud.position[p] - origin_) / step_;
    Cell c;
    bool inside = true;
    for (std::size_t a = 0; a < 3; ++a) {
      c[a] = static_cast<std::ptrdiff_t>(std::floor(u[static_cast<int>(a)] + 0.5));
      inside &= c[a] >= -kPad[a] && c[a] <= cells_[a] + kPad[a];
    }
    if (inside) excess_[node(c)] += cloud.liquid[p] ? 1.0F : -1.0F;
  };
  // Particles between two planes of nodes mark one of these two: every other pair of planes at a time.
  for (const std::ptrdiff_t first : {0, 1}) {
#pragma omp parallel for schedule(dynamic, 1)
    for (std::ptrdiff_t plane = first; plane < rows.planes; plane += 2) {
      const auto row = static_cast<std::size_t>(plane * rows.along_y);
      for (std::size_t q = rows.start[row]; q < rows.start[row + static_cast<std::size_t>(rows.along_y)]; ++q)
        mark(rows.order[q]);
    }
  }
}

void SmoothedField::open_slits() {
  corner_value_ = metal_;  // sharp
  const float* sharp = corner_value_.data();
  filter(metal_, nodes_, binomial(kSharpToSoft));
  std::vector<float> wide = metal_;
  filter(wide, nodes_, binomial(kSoftToWide));
  parallel_for(nodes_[1] * nodes_[2], [&](std::ptrdiff_t row) {
    float* const soft = metal_.data() + row * nodes_[0];
    const float *const s = sharp + row * nodes_[0], *const w = wide.data() + row * nodes_[0];
#pragma omp simd
    for (std::ptrdiff_t i = 0; i < nodes_[0]; ++i)
      soft[i] -= kSharpening * slit(soft[i], w[i]) * std::max(soft[i] - s[i], 0.0F);
  });
}

void SmoothedField::evaluate_corners() {
  // A cubic spline at a node weighs the coefficients there and beside it 1/6, 2/3, 1/6.
  corner_value_ = metal_;
  filter(corner_value_, nodes_, {2.0F / 3, 1.0F / 6});
}

bool SmoothedField::liquid(const Cell& cell, const Vec3& local) const {
  if (excess_.empty()) return false;
  const Eigen::Vector3f t = local.cast<float>();
  const Weights x = spline(t.x()), y = spline(t.y()), z = spline(t.z());
  Quad sum = 0;
  for_rows(excess_, cell,
           [&](std::size_t a, std::size_t b, const float* row) { sum += y[a] * z[b] * load(row); });
  return stdx::reduce(load(x.data()) * sum) > 0;
}

/// Value and gradient of the spline.
SmoothedField::Sample SmoothedField::sample(const Cell& cell, const Vec3& local) const {
  const Eigen::Vector3f t = local.cast<float>();
  const Weights x = spline(t.x()), y = spline(t.y()), z = spline(t.z());
  const Weights dx = spline_derivative(t.x()), dy = spline_derivative(t.y()), dz = spline_derivative(t.z());
  Quad value = 0, along_y = 0, along_z = 0;
  for_rows(metal_, cell, [&](std::size_t a, std::size_t b, const float* row) {
    const Quad m = load(row);
    value += y[a] * z[b] * m;
    along_y += dy[a] * z[b] * m;
    along_z += y[a] * dz[b] * m;
  });
  const Quad wx = load(x.data());
  return {stdx::reduce(wx * value), Vec3(stdx::reduce(load(dx.data()) * value), stdx::reduce(wx * along_y),
                                         stdx::reduce(wx * along_z))};
}

/// Calls f(a, b, row) for the four times four rows of nodes, in y and z, that the spline in a cell needs.
template <class F>
void SmoothedField::for_rows(const std::vector<float>& nodes, const Cell& cell, F&& f) const {
  const float* const corner = nodes.data() + node({cell[0] - 1, cell[1] - 1, cell[2] - 1});
  for (std::size_t b = 0; b < 4; ++b)
    for (std::size_t a = 0; a < 4; ++a)
      f(a, b,
        corner + (static_cast<std::ptrdiff_t>(b) * nodes_[1] + static_cast<std::ptrdiff_t>(a)) * nodes_[0]);
}

}  // namespace meltray::laser
