// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <optional>

#include "meltray/core/parallel.hpp"
#include "meltray/observe/capillary.hpp"
#include "meltray/observe/history.hpp"
#include "meltray/observe/pool.hpp"

namespace meltray::observe {
namespace {

/// A corner of the domain in x, y, z whatever the dimension.
Vec3 corner(const scene::Domain& domain, const Vec3& v) {
  return domain.dimension == 3 ? v : Vec3(v[0], 0, v[1]);
}

/// Whether there is a workpiece, solid metal, that a void can reach into.
bool has_solid(const Particles& p) {
  const double any = parallel_max(static_cast<std::ptrdiff_t>(p.size()), 0.0, [&](std::ptrdiff_t i) {
    return is_material(p, i) && !p.is_liquid(i) ? 1.0 : 0.0;
  });
  return any > 0;
}

/// The void is looked for where the melt and the beam are and somewhat around (melt may have left the deepest
/// part of the ground bare), never outside the workpiece: beyond its faces there is empty space that is no
/// capillary.
VoidRegion region_around(const Pool& pool, const std::optional<Vec3>& axis, double reach,
                         const scene::Domain& domain) {
  const double side = 3 * domain.spacing, down = 6 * domain.spacing;
  const Vec3 low = corner(domain, domain.min), high = corner(domain, domain.max);
  VoidRegion r{pool.min, pool.max};
  for (int d = 0; d < domain.dimension - 1; ++d) {
    if (axis) {
      r.min[d] = std::min(r.min[d], (*axis)[d] - reach);
      r.max[d] = std::max(r.max[d], (*axis)[d] + reach);
    }
    r.min[d] = std::max(r.min[d] - side, low[d] + 0.5 * domain.spacing);
    r.max[d] = std::min(r.max[d] + side, high[d] - 0.5 * domain.spacing);
  }
  r.min[2] = std::max(r.min[2] - down, low[2]);
  r.max[2] = std::max(r.max[2], 0.0) + side;
  return r;
}

}  // namespace

HistoryRow measure(const scene::Simulation& simulation, const StepsSinceRow& since) {
  const auto& scene = simulation.scene();
  const Particles& p = simulation.particles();
  const double spacing = scene.domain.spacing;
  const double t = simulation.time();
  HistoryRow row;
  row.time = t;

  const auto laser = simulation.laser_state();
  row.laser_power = laser.power;
  row.absorbed = laser.absorbed;
  row.escaped = laser.escaped;
  row.residual = laser.residual;

  const auto* beam = simulation.beam();
  std::optional<Vec3> axis;
  double reach = 0;
  if (beam != nullptr) {
    axis = beam->focus(t);
    reach = beam->spec().focal_diameter;
  }
  const Pool pool = measure_pool(p, spacing, axis, reach);
  row.pool_length = pool.length;
  row.pool_width = pool.width;
  row.pool_depth = pool.depth;
  row.top_surface = top_surface(p, spacing, pool);
  if (pool.exists && has_solid(p))
    row.capillary_depth = void_depth(p, spacing, region_around(pool, axis, reach, scene.domain));
  if (beam != nullptr && simulation.tracer() != nullptr) {
    row.axis_depth = axis_depth(*simulation.tracer(), *beam, t, spacing, -scene.domain.min[2]);
    row.closed = capillary_closed(row.capillary_depth, row.axis_depth, spacing);
  }

  const auto count = static_cast<std::ptrdiff_t>(p.size());
  row.max_temperature =
      parallel_max(count, 0.0, [&](std::ptrdiff_t i) { return is_material(p, i) ? p.temperature[i] : 0.0; });
  row.max_speed = std::sqrt(parallel_max(count, 0.0, [&](std::ptrdiff_t i) {
    return is_material(p, i) && p.is_liquid(i) ? velocity(p, i).squaredNorm() : 0.0;
  }));
  row.liquid = simulation.liquid_count();
  row.active = simulation.active_count();
  row.ejected_mass = simulation.mass().ejected;
  row.evaporative_loss = simulation.evaporative_loss();
  row.density_variation = simulation.density_variation().now;
  row.dt = since.mean_step();
  row.limiter = since.main_limiter();
  row.steps = simulation.counters().steps;
  row.energy = simulation.energy();
  row.energy_error = row.energy.relative_error();
  return row;
}

}  // namespace meltray::observe
