// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>
#include <vector>

#include "laser/cell_grid.hpp"
#include "laser/cubes.hpp"
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

struct Share {
  std::size_t particle;
  double power;
};

/// The surface particles around a group of hits, side by side.
struct Candidates {
  std::vector<double> x, y, z, weight, share, power;
  std::vector<std::size_t> particle;

  void collect(const CellGrid& grid, const HitGroup& group, double radius, const double* weight_of,
               const std::vector<std::size_t>& particle_of) {
    for (auto* v : {&x, &y, &z, &weight}) v->clear();
    particle.clear();
    const double reach = radius + 0.5 * std::sqrt(3.0) * group.edge;
    grid.near(group.centre, reach, [&](std::size_t i, const Vec3& point) {
      if ((point - group.centre).squaredNorm() >= reach * reach) return;
      x.push_back(point.x());
      y.push_back(point.y());
      z.push_back(point.z());
      weight.push_back(weight_of[particle_of[i]]);
      particle.push_back(particle_of[i]);
    });
    share.resize(x.size());
    power.assign(x.size(), 0.0);
  }

  /// Shares a hit out; false where no candidate is within the radius.
  bool take(const Hit& hit, double radius) {
    const double px = hit.position.x(), py = hit.position.y(), pz = hit.position.z(), inverse = 1 / radius;
    const std::size_t n = x.size();
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t c = 0; c < n; ++c) {
      const double r2 = (x[c] - px) * (x[c] - px) + (y[c] - py) * (y[c] - py) + (z[c] - pz) * (z[c] - pz);
      const double fall = std::max(1 - std::sqrt(r2) * inverse, 0.0);
      share[c] = weight[c] * fall * fall;
      sum += share[c];
    }
    if (!(sum > 0)) return false;
    const double scale = hit.power / sum;
#pragma omp simd
    for (std::size_t c = 0; c < n; ++c) power[c] += scale * share[c];
    return true;
  }
};

}  // namespace

std::vector<HitGroup> group_hits(std::vector<Hit>& hits, double edge, double& lost) {
  lost = 0;
  std::erase_if(hits, [&](const Hit& hit) {
    if (hit.position.allFinite()) return false;
    lost += hit.power;
    return true;
  });
  const Cubes cubes(hits, edge);
  struct Key {
    std::uint64_t cube;
    std::size_t hit;
    auto operator<=>(const Key&) const = default;
  };
  std::vector<Key> keys(hits.size());
  for (std::size_t h = 0; h < hits.size(); ++h) keys[h] = {cubes.number(hits[h].position), h};
  std::sort(keys.begin(), keys.end());
  std::vector<Hit> sorted;
  sorted.reserve(hits.size());
  std::vector<HitGroup> groups;
  for (std::size_t h = 0; h < keys.size(); ++h) {
    sorted.push_back(hits[keys[h].hit]);
    if (h == 0 || cubes.at(sorted[h].position) != cubes.at(sorted[h - 1].position))
      groups.push_back({cubes.centre(sorted[h].position), edge, h, h});
    groups.back().last = h + 1;
  }
  hits = std::move(sorted);
  return groups;
}

double deposit(std::span<const Hit> hits, std::span<const HitGroup> groups, const PointCloud& cloud,
               const double* weight, double radius, double* power) {
  if (!(radius > 0)) throw NumericalFailure("laser: the radius of the deposit must be positive");
  std::vector<Vec3> points;
  std::vector<std::size_t> particle;
  for (std::size_t i = 0; i < cloud.size; ++i) {
    const Vec3 x(cloud.position[0][i], cloud.position[1][i], cloud.position[2][i]);
    if (!(weight[i] > 0) || !x.allFinite()) continue;
    points.push_back(x);
    particle.push_back(i);
  }
  if (points.empty()) {
    double undeposited = 0;
    for (const Hit& hit : hits) undeposited += hit.power;
    return undeposited;
  }
  const CellGrid grid(points, 0.5 * radius);  // smaller cells fit the sphere more closely
  // Blocks of groups find their particles side by side; their shares are added in the order of the groups.
  constexpr std::ptrdiff_t kGroupsPerBlock = 32;
  const auto count = static_cast<std::ptrdiff_t>(groups.size());
  const std::ptrdiff_t blocks = (count + kGroupsPerBlock - 1) / kGroupsPerBlock;
  std::vector<std::vector<Share>> shares(static_cast<std::size_t>(blocks));
  const auto share_out = [&](const HitGroup& group, Candidates& near, std::vector<Share>& out) {
    near.collect(grid, group, radius, weight, particle);
    for (std::size_t h = group.first; h < group.last; ++h)
      if (!near.take(hits[h], radius))
        out.push_back({particle[nearest(grid, hits[h].position, radius)], hits[h].power});
    for (std::size_t c = 0; c < near.power.size(); ++c)
      if (near.power[c] > 0) out.push_back({near.particle[c], near.power[c]});
  };
#pragma omp parallel if (blocks > 1)
  {
    Candidates near;
#pragma omp for schedule(dynamic, 1)
    for (std::ptrdiff_t b = 0; b < blocks; ++b)
      for (std::ptrdiff_t g = b * kGroupsPerBlock; g < std::min(count, (b + 1) * kGroupsPerBlock); ++g)
        share_out(groups[static_cast<std::size_t>(g)], near, shares[static_cast<std::size_t>(b)]);
  }
  for (const auto& block : shares)
    for (const Share& s : block) power[s.particle] += s.power;
  return 0;
}

}  // namespace meltray::laser
