// SPDX-License-Identifier: MIT
#include "meltray/observe/capillary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "meltray/core/collect.hpp"
#include "meltray/core/constants.hpp"
#include "meltray/core/parallel.hpp"
#include "meltray/observe/pool.hpp"

namespace meltray::observe {
namespace {

constexpr double kVoxel = 0.5;    // spacings
constexpr double kSupport = 1.5;  // spacings
constexpr float kThreshold = 0.5F;
constexpr std::int64_t kSlab = 8;  // layers of voxels that are filled together

/// Metal as a smoothed volume fraction on a regular grid, with a mark on what is anchored by solid.
class VoxelGrid {
 public:
  VoxelGrid(const Particles& p, double spacing, const VoidRegion& region)
      : flat_(p.dim == 2), voxel_(kVoxel * spacing), origin_(region.min) {
    for (int d = 0; d < 3; ++d)
      n_[d] = std::max<std::int64_t>(
          1, static_cast<std::int64_t>(std::ceil((region.max[d] - region.min[d]) / voxel_)));
    if (flat_) {
      n_[1] = 1;
      origin_[1] = -0.5 * voxel_;
    }
    fraction_.assign(static_cast<std::size_t>(n_[0] * n_[1] * n_[2]), 0.0F);
    anchored_.assign(fraction_.size(), 0);
    // Integral of (1 - r/R)^2 is 2 pi R^3/15 in space and pi R^2/6 in the plane.
    const double radius = kSupport * spacing;
    const double scale = flat_ ? spacing * spacing / (constants::pi * radius * radius / 6)
                               : std::pow(spacing, 3) / (2 * constants::pi * std::pow(radius, 3) / 15);
    spread(p, radius, static_cast<float>(scale));
  }

  double depth() {
    drop_loose_metal();
    std::int64_t lowest = n_[2];
    std::int64_t at = -1;
    flood([this](auto&& seed) { for_top_layer(seed); },
          [this](std::int64_t v) { return fraction_[v] < kThreshold; },
          [&](std::int64_t v) {
            const std::int64_t k = v / (n_[0] * n_[1]);
            // Of equally low voxels the emptier one: its ground is the deeper one.
            if (k < lowest || (k == lowest && below(v) < below(at))) {
              lowest = k;
              at = v;
            }
          });
    if (at < 0) return 0;
    const double z = origin_[2] + (static_cast<double>(lowest) + 0.5) * voxel_;
    double down = 0.5;  // at the lower edge of the region the void goes on
    if (lowest > 0) {
      const double here = fraction_[at], under = below(at);
      down = (kThreshold - here) / std::max(under - here, 1e-6);
    }
    return std::max(0.0, -(z - std::clamp(down, 0.0, 1.0) * voxel_));
  }

 private:
  double below(std::int64_t v) const {
    const std::int64_t u = v - n_[0] * n_[1];
    return u >= 0 ? fraction_[u] : 0;
  }

  /// First and last voxel along axis d whose centre lies within `radius` of x; empty where first > last.
  std::pair<std::int64_t, std::int64_t> reach(int d, double x, double radius) const {
    const double at = (x - origin_[d]) / voxel_ - 0.5, cells = radius / voxel_;
    return {std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(at - cells))),
            std::min<std::int64_t>(n_[d] - 1, static_cast<std::int64_t>(std::floor(at + cells)))};
  }

  /// Adds every particle to the voxels around it. Slabs of voxels are filled side by side, each by its
  /// particles in ascending order, so that the sums do not depend on the number of threads.
  void spread(const Particles& p, double radius, float scale) {
    std::vector<Index> near;
    parallel_collect(static_cast<std::ptrdiff_t>(p.size()), kLight.size, near,
                     [&](std::ptrdiff_t i, std::vector<Index>& found) {
                       if (p.has(i, kRemoved)) return;
                       const Vec3 x = position(p, i);
                       bool outside = false;
                       for (int d = 0; d < 3; ++d)
                         outside = outside || x[d] < origin_[d] - radius ||
                                   x[d] > origin_[d] + n_[d] * voxel_ + radius;
                       if (!outside) found.push_back(static_cast<Index>(i));
                     });
    const std::int64_t slabs = (n_[2] + kSlab - 1) / kSlab;
    std::vector<std::vector<Index>> of_slab(slabs);
    for (const Index i : near) {
      const auto [first, last] = reach(2, position(p, i)[2], radius);
      for (std::int64_t s = first / kSlab; first <= last && s <= last / kSlab; ++s) of_slab[s].push_back(i);
    }
#pragma omp parallel for schedule(dynamic, 1)
    for (std::int64_t s = 0; s < slabs; ++s)
      for (const Index i : of_slab[s])
        spread_one(position(p, i), radius, scale, !p.is_liquid(i), s * kSlab,
                   std::min(n_[2], (s + 1) * kSlab) - 1);
  }

  /// Adds one particle to the voxels of layers bottom to top.
  void spread_one(const Vec3& x, double radius, float scale, bool solid, std::int64_t bottom,
                  std::int64_t top) {
    const auto [i0, i1] = reach(0, x[0], radius);
    const auto [j0, j1] = reach(1, x[1], radius);
    auto [k0, k1] = reach(2, x[2], radius);
    k0 = std::max(k0, bottom);
    k1 = std::min(k1, top);
    const auto offset2 = [&](int d, std::int64_t at) {
      const double o = origin_[d] + (static_cast<double>(at) + 0.5) * voxel_ - x[d];
      return static_cast<float>(o * o / (radius * radius));
    };
    std::array<float, 8> x2{};  // a support is 6 voxels wide
    for (std::int64_t i = i0; i <= i1; ++i) x2[i - i0] = offset2(0, i);
    for (std::int64_t k = k0; k <= k1; ++k)
      for (std::int64_t j = j0; j <= j1; ++j) {
        const float yz2 = offset2(2, k) + offset2(1, j);
        const std::int64_t row = (k * n_[1] + j) * n_[0];
        for (std::int64_t i = i0; i <= i1; ++i) {
          const float r2 = yz2 + x2[i - i0];
          if (r2 >= 1) continue;
          const float q = 1 - std::sqrt(r2);
          fraction_[row + i] += scale * q * q;
          if (solid) anchored_[row + i] = 1;
        }
      }
  }

  template <class Seed>
  void for_top_layer(Seed&& seed) const {
    for (std::int64_t v = (n_[2] - 1) * n_[1] * n_[0]; v < n_[2] * n_[1] * n_[0]; ++v) seed(v);
  }

  /// Voxels of solid, at the sides and at the bottom.
  template <class Seed>
  void for_anchors(Seed&& seed) const {
    std::int64_t v = 0;
    for (std::int64_t k = 0; k < n_[2]; ++k)
      for (std::int64_t j = 0; j < n_[1]; ++j)
        for (std::int64_t i = 0; i < n_[0]; ++i, ++v) {
          const bool edge = k == 0 || i == 0 || i == n_[0] - 1 || (!flat_ && (j == 0 || j == n_[1] - 1));
          if (edge || anchored_[v]) seed(v);
        }
  }

  /// Metal that cannot be reached from solid or from the side or bottom of the region becomes void.
  void drop_loose_metal() {
    const auto held =
        flood([this](auto&& seed) { for_anchors(seed); },
              [this](std::int64_t u) { return fraction_[u] >= kThreshold; }, [](std::int64_t) {});
    for (std::size_t u = 0; u < fraction_.size(); ++u)
      if (!held[u]) fraction_[u] = std::min(fraction_[u], 0.49F);
  }

  /// Visits every voxel that fulfils `inside` and is connected over faces to a seed that does, and marks it
  /// with 1 in the result.
  template <class Seeds, class Inside, class Visit>
  std::vector<std::uint8_t> flood(Seeds&& for_seeds, Inside&& inside, Visit&& visit) const {
    std::vector<std::uint8_t> seen(fraction_.size(), 0);
    std::vector<std::uint32_t> open;
    const auto push = [&](std::int64_t v) {
      if (seen[v] || !inside(v)) return;
      seen[v] = 1;
      visit(v);
      open.push_back(static_cast<std::uint32_t>(v));
    };
    for_seeds(push);
    while (!open.empty()) {
      const std::int64_t v = open.back();
      open.pop_back();
      const std::int64_t i = v % n_[0], j = v / n_[0] % n_[1], k = v / (n_[0] * n_[1]);
      if (i > 0) push(v - 1);
      if (i + 1 < n_[0]) push(v + 1);
      if (j > 0) push(v - n_[0]);
      if (j + 1 < n_[1]) push(v + n_[0]);
      if (k > 0) push(v - n_[0] * n_[1]);
      if (k + 1 < n_[2]) push(v + n_[0] * n_[1]);
    }
    return seen;
  }

  bool flat_;
  double voxel_;
  Vec3 origin_;
  std::int64_t n_[3]{};
  std::vector<float> fraction_;
  std::vector<std::uint8_t> anchored_;
};

}  // namespace

double void_depth(const Particles& p, double spacing, const VoidRegion& region) {
  return VoxelGrid(p, spacing, region).depth();
}

double axis_depth(const laser::Tracer& tracer, const laser::Beam& beam, double t, double spacing,
                  double thickness) {
  const auto& vertices = tracer.mesh().vertices;
  if (tracer.mesh().triangles.empty()) return 0;
  double top = 0;
  for (const auto& v : vertices) top = std::max(top, v[2]);
  bool any = false;
  double lowest = 1e300;
  for (const auto& ray : beam.axis_bundle(t, top + spacing))
    if (const auto hit = tracer.first_hit(ray)) {
      any = true;
      lowest = std::min(lowest, (*hit)[2]);
    }
  return any ? std::max(0.0, -lowest) : thickness;
}

}  // namespace meltray::observe
