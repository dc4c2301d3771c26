// SPDX-License-Identifier: MIT
#include "meltray/observe/pool.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "meltray/core/collect.hpp"
#include "meltray/core/parallel.hpp"

namespace meltray::observe {
namespace {

constexpr double kLink = 1.5;              // spacings
constexpr std::size_t kSmallestSeam = 20;  // particles

using Cell = std::array<std::int64_t, 3>;

Cell cell_of(const Vec3& x, double size) {
  return {static_cast<std::int64_t>(std::floor(x[0] / size)),
          static_cast<std::int64_t>(std::floor(x[1] / size)),
          static_cast<std::int64_t>(std::floor(x[2] / size))};
}

std::int32_t root(std::vector<std::int32_t>& parent, std::int32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

std::vector<std::int32_t> clusters(const Particles& p, const std::vector<std::int32_t>& selected,
                                   double link) {
  const auto n = static_cast<std::int32_t>(selected.size());
  std::vector<std::pair<Cell, std::int32_t>> sorted(selected.size());
  for (std::int32_t k = 0; k < n; ++k) sorted[k] = {cell_of(position(p, selected[k]), link), k};
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::int32_t> parent(selected.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const auto& [cell, k] : sorted) {
    const Vec3 xk = position(p, selected[k]);
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        // Cells of one column (z) are neighbours in the sorted order: one search for three cells.
        const std::pair<Cell, std::int32_t> from{{cell[0] + dx, cell[1] + dy, cell[2] - 1}, 0};
        const Cell last{cell[0] + dx, cell[1] + dy, cell[2] + 1};
        for (auto it = std::lower_bound(sorted.begin(), sorted.end(), from);
             it != sorted.end() && it->first <= last; ++it) {
          if (it->second <= k || (position(p, selected[it->second]) - xk).squaredNorm() > link * link)
            continue;
          const std::int32_t a = root(parent, k), b = root(parent, it->second);
          parent[std::max(a, b)] = std::min(a, b);
        }
      }
  }
  std::vector<std::int32_t> label(selected.size());
  std::int32_t next = 0;
  for (std::int32_t k = 0; k < n; ++k) label[k] = parent[k] == k ? next++ : label[root(parent, k)];
  return label;
}

Pool measure_pool(const Particles& p, double spacing, std::optional<Vec3> beam, double reach) {
  std::vector<std::int32_t> liquid;
  parallel_collect(static_cast<std::ptrdiff_t>(p.size()), kLight.size, liquid,
                   [&](std::ptrdiff_t i, std::vector<std::int32_t>& found) {
                     if (p.is_liquid(i) && is_material(p, i)) found.push_back(static_cast<std::int32_t>(i));
                   });
  Pool pool;
  if (liquid.empty()) return pool;

  const auto label = clusters(p, liquid, kLink * spacing);
  struct Candidate {
    std::size_t count = 0;
    bool near = false;
  };
  std::vector<Candidate> found(*std::max_element(label.begin(), label.end()) + 1);
  for (std::size_t k = 0; k < liquid.size(); ++k) {
    auto& c = found[label[k]];
    ++c.count;
    if (beam && !c.near) {
      const Vec3 d = position(p, liquid[k]) - *beam;
      c.near = d[0] * d[0] + d[1] * d[1] <= reach * reach;
    }
  }
  const auto best = std::max_element(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) {
    return a.near != b.near ? b.near : a.count < b.count;
  });
  const auto chosen = static_cast<std::int32_t>(best - found.begin());

  pool.exists = true;
  pool.particles = best->count;
  pool.min.setConstant(1e300);
  pool.max.setConstant(-1e300);
  for (std::size_t k = 0; k < liquid.size(); ++k)
    if (label[k] == chosen) {
      const Vec3 x = position(p, liquid[k]);
      pool.min = pool.min.cwiseMin(x);
      pool.max = pool.max.cwiseMax(x);
    }
  pool.length = pool.max[0] - pool.min[0] + spacing;
  pool.width = p.dim == 3 ? pool.max[1] - pool.min[1] + spacing : 0;
  pool.depth = std::max(0.0, -(pool.min[2] - 0.5 * spacing));
  pool.top = pool.max[2] + 0.5 * spacing;
  return pool;
}

double top_surface(const Particles& p, double spacing, const Pool& pool) {
  // Frozen spatter is solid too, so re-solidified particles do not count here.
  const double top = parallel_max(
      static_cast<std::ptrdiff_t>(p.size()), pool.exists ? pool.max[2] : -1e300, [&](std::ptrdiff_t i) {
        const bool counts = !p.is_liquid(i) && is_material(p, i) && !p.has(i, kResolidified);
        return counts ? position(p, i)[2] : -1e300;
      });
  return top > -1e300 ? top + 0.5 * spacing : 0;
}

std::vector<SeamSection> measure_seam(const Particles& p, double spacing) {
  std::vector<std::int32_t> seam;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (p.has(i, kResolidified) && !p.is_liquid(i) && is_material(p, i))
      seam.push_back(static_cast<std::int32_t>(i));
  const auto label = clusters(p, seam, kLink * spacing);
  std::vector<std::size_t> count(seam.size());
  for (const auto l : label) ++count[l];

  struct Extent {
    double y_min = 1e300, y_max = -1e300, z_min = 1e300, z_max = -1e300;
    std::size_t n = 0;
  };
  std::map<std::int64_t, Extent> sections;
  for (std::size_t k = 0; k < seam.size(); ++k) {
    if (count[label[k]] < kSmallestSeam) continue;
    const Vec3 x = position(p, seam[k]);
    Extent& e = sections[static_cast<std::int64_t>(std::floor(x[0] / spacing))];
    e.y_min = std::min(e.y_min, x[1]);
    e.y_max = std::max(e.y_max, x[1]);
    e.z_min = std::min(e.z_min, x[2]);
    e.z_max = std::max(e.z_max, x[2]);
    ++e.n;
  }
  std::vector<SeamSection> out;
  for (const auto& [bin, e] : sections)
    out.push_back({(static_cast<double>(bin) + 0.5) * spacing, std::max(0.0, -(e.z_min - 0.5 * spacing)),
                   p.dim == 3 ? e.y_max - e.y_min + spacing : 0, e.z_max + 0.5 * spacing, e.n});
  return out;
}

}  // namespace meltray::observe
