// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "laser/cell_grid.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/core/parallel.hpp"
#include "meltray/laser/laser.hpp"

namespace meltray::laser {
namespace {

constexpr std::size_t kNone = ~std::size_t{0};

/// Index of the nearest point; of equally near ones the first.
std::size_t nearest(const CellGrid& grid, const Vec3& x, double radius) {
  const double reach = (x - grid.centre()).norm() + grid.diagonal();
  for (;; radius *= 2) {
    std::size_t best = kNone;
    double best2 = std::numeric_limits<double>::infinity();
    grid.near(x, radius, [&](std::size_t i, const Vec3& point) {
      const double r2 = (point - x).squaredNorm();
      if (r2 < best2 || (r2 == best2 && i < best)) {
        best2 = r2;
        best = i;
      }
    });
    // A point beyond the radius may be beaten by one in a cell that was not looked at.
    if (best != kNone && (best2 <= radius * radius || radius > reach)) return best;
    if (radius > reach) return kNone;
  }
}

}  // namespace

double deposit(std::span<const Hit> hits, const PointCloud& cloud, const double* weight, double radius,
               double* power) {
  if (!(radius > 0)) throw NumericalFailure("laser: the radius of the deposit must be positive");
  std::vector<Vec3> points;
  std::vector<std::size_t> particle;
  for (std::size_t i = 0; i < cloud.size; ++i) {
    const Vec3 x(cloud.position[0][i], cloud.position[1][i], cloud.position[2][i]);
    if (!(weight[i] > 0) || !x.allFinite()) continue;
    points.push_back(x);
    particle.push_back(i);
  }
  const CellGrid grid(points, 0.5 * radius);  // smaller cells fit the sphere more closely
  // Blocks of hits find their particles side by side; their shares are added in the order of the hits.
  struct Share {
    std::size_t particle;
    double power;
  };
  constexpr std::ptrdiff_t kHitsPerBlock = 64;
  const auto count = static_cast<std::ptrdiff_t>(hits.size());
  const std::ptrdiff_t blocks = (count + kHitsPerBlock - 1) / kHitsPerBlock;
  std::vector<std::vector<Share>> shares(static_cast<std::size_t>(blocks));
  const auto lost = [&](const Hit& hit) { return points.empty() || !hit.position.allFinite(); };
  const auto share_out = [&](const Hit& hit, std::vector<Share>& out) {
    if (lost(hit)) return;
    const std::size_t first = out.size();
    double sum = 0;
    grid.near(hit.position, radius, [&](std::size_t i, const Vec3& point) {
      const double r2 = (point - hit.position).squaredNorm();
      if (r2 >= radius * radius) return;
      const double fall = 1 - std::sqrt(r2) / radius;
      out.push_back({particle[i], weight[particle[i]] * fall * fall});
      sum += out.back().power;
    });
    if (sum > 0)
      for (std::size_t k = first; k < out.size(); ++k) out[k].power = hit.power * (out[k].power / sum);
    else
      out.push_back({particle[nearest(grid, hit.position, radius)], hit.power});
  };
#pragma omp parallel for schedule(dynamic, 1) if (count >= kSerialBelow)
  for (std::ptrdiff_t b = 0; b < blocks; ++b)
    for (std::ptrdiff_t h = b * kHitsPerBlock; h < std::min(count, (b + 1) * kHitsPerBlock); ++h)
      share_out(hits[h], shares[b]);
  for (const auto& block : shares)
    for (const Share& s : block) power[s.particle] += s.power;
  double undeposited = 0;
  for (const Hit& hit : hits)
    if (lost(hit)) undeposited += hit.power;
  return undeposited;
}

}  // namespace meltray::laser
