// SPDX-License-Identifier: MIT
#include "scene/laser_coupling.hpp"

#include <algorithm>
#include <cmath>

#include "meltray/core/collect.hpp"
#include "meltray/core/parallel.hpp"
#include "meltray/scene/optics.hpp"

namespace meltray::scene {

namespace {

/// Hits reach surface particles within this many spacings: a hit on the isosurface is half a spacing above
/// the centres of the outermost layer and at most 0.9 spacings from the nearest of them.
constexpr double kDepositRadius = 1.3;
/// Hits that share a cube of this many spacings look for their particles together.
constexpr double kHitGroup = 0.5;
/// Edge of the cubes in which the error of a trace is taken, in spacings: about as far as hits are spread.
constexpr double kErrorCube = 2;
/// Spacings around what light reaches that the surface there depends on: reach of its smoothed field and
/// more.
constexpr double kMargin = 4;

laser::TraceOptions options_of(const Scene& scene) {
  laser::TraceOptions o = scene.laser->trace;
  const LaserIndex index = laser_index(scene);
  o.index_solid = index.solid;
  o.index_liquid = index.liquid;
  return o;
}

}  // namespace

LaserCoupling::LaserCoupling(const Scene& scene, const terms::SceneConstants& constants)
    : scene_(scene),
      constants_(constants),
      beam_(scene.laser->beam),
      ray_count_(scene.laser->trace.ray_error, scene.laser->trace.rays) {}

bool LaserCoupling::due(double t) const {
  const double near = scene_.laser->retrace_motion * constants_.spacing;
  return stale_ || t >= next_trace_ || motion_ > near || (beam_.focus(t) - traced_focus_).norm() > near ||
         (beam_.power(t) > 0) != (ledger_.in > 0);
}

laser::Box LaserCoupling::region(double t, const Particles& particles, const PatchSelector& selector) const {
  // The footprint of the beam on the top, the melt around it and where light went last time, with a margin.
  const double margin = kMargin * constants_.spacing;
  const laser::BeamSpec& spec = beam_.spec();
  const Vec3 focus = beam_.focus(t), axis = beam_.axis();
  const double reach = 2.5 * beam_.radius(std::abs(spec.focus_z)) + margin;
  Vec3 low = focus - Vec3(reach, reach, 0), high = focus + Vec3(reach, reach, 0);
  low[2] = -margin;
  high[2] = margin;
  const double window = 0.6 * spec.focal_diameter + 10 * constants_.spacing;
  double deepest = 0;
  for (const laser::Hit& hit : hits_) deepest = std::min(deepest, hit.position[2]);
  for (Index i : selector.moving()) {
    const double z = particles.x[2][i], on_axis = focus[0] + axis[0] / -axis[2] * (spec.focus_z - z);
    if (std::abs(particles.x[1][i] - focus[1]) > window || std::abs(particles.x[0][i] - on_axis) > window)
      continue;
    deepest = std::min(deepest, z);
    high[2] = std::max(high[2], z + margin);
  }
  low[2] = deepest - margin;
  const double shift = axis[0] / -axis[2] * (spec.focus_z - low[2]);
  low[0] = std::min(low[0], low[0] + shift);
  high[0] = std::max(high[0], high[0] + shift);
  high[2] = std::min(high[2], scene_.domain.max[2]);
  return {low.cwiseMax(scene_.domain.min), high.cwiseMin(scene_.domain.max)};
}

void LaserCoupling::trace(double t, const PatchSelector& selector, const Particles& particles) {
  stale_ = false;
  motion_ = 0;
  traced_focus_ = beam_.focus(t);
  next_trace_ = t + scene_.laser->retrace_interval;
  const laser::Box box = region(t, particles, selector);
  const double beyond = 3 * constants_.spacing;
  selector.gather(particles, box.min - Vec3::Constant(beyond), box.max + Vec3::Constant(beyond), cloud_);
  std::erase_if(cloud_, [&](Index i) { return particles.is_wall(i); });
  liquid_.resize(cloud_.size());
  parallel_for(static_cast<std::ptrdiff_t>(cloud_.size()),
               [&](std::ptrdiff_t k) { liquid_[k] = particles.is_liquid(cloud_[k]); });
  tracer_.set_mesh(laser::reconstruct_surface(cloud_at(particles.x, liquid_.data()), box));

  hits_.clear();
  ledger_ = {};
  groups_.clear();
  lost_ = 0;
  lit_.clear();
  if (beam_.power(t) <= 0) return;
  const laser::TraceOptions options = options_of(scene_);
  const int count = options.ray_error > 0 ? ray_count_.next() : options.rays;
  const auto rays = beam_.rays(t, count, box.max[2] + constants_.spacing, budget_.traces);
  laser::Trace trace = tracer_.trace(rays, options);
  ledger_ = trace.ledger;
  hits_ = std::move(trace.hits);
  budget_.rays += count;
  if (options.ray_error > 0)
    ray_count_.learn(laser::sampling_error(hits_, kErrorCube * constants_.spacing), count);
  const double error =
      std::abs(ledger_.in - ledger_.absorbed - ledger_.escaped - ledger_.residual - ledger_.dropped);
  budget_.worst = std::max(budget_.worst, error / ledger_.in);
  ++budget_.traces;
  budget_.dropped_rays += ledger_.dropped_rays;
  group_hits();
  const double radius = (kDepositRadius + kHitGroup) * constants_.spacing;
  parallel_collect(static_cast<std::ptrdiff_t>(groups_.size()), 64, lit_,
                   [&](std::ptrdiff_t g, std::vector<Index>& near) {
                     selector.for_resting_near(particles, groups_[static_cast<std::size_t>(g)].centre, radius,
                                               [&](Index i) { near.push_back(i); });
                   });
  std::sort(lit_.begin(), lit_.end());
  lit_.erase(std::unique(lit_.begin(), lit_.end()), lit_.end());
}

/// The particles of cloud_, which stand at x, for the room of the laser.
laser::PointCloud LaserCoupling::cloud_at(const Components& x, const std::uint8_t* liquid) {
  for (auto& along : cx_) along.resize(cloud_.size());
  parallel_for(static_cast<std::ptrdiff_t>(cloud_.size()), [&](std::ptrdiff_t k) {
    for (int c = 0; c < 3; ++c) cx_[c][k] = x[c][cloud_[k]];
  });
  return {{cx_[0].data(), cx_[1].data(), cx_[2].data()}, cloud_.size(), liquid, constants_.spacing};
}

void LaserCoupling::group_hits() {
  groups_ = laser::group_hits(hits_, kHitGroup * constants_.spacing, lost_);
}

void LaserCoupling::deposit(const terms::Stage& stage, std::vector<double>& power) {
  power.assign(stage.size(), 0.0);
  undeposited_ = lost_;
  if (hits_.empty()) return;
  // Only surface particles take part; the cloud handed over is just them.
  parallel_collect(stage.size(), kLight.size, cloud_, [&](std::ptrdiff_t i, std::vector<Index>& found) {
    if (stage.surface[i] > 0 && stage.heat[i] && !stage.loose[i]) found.push_back(static_cast<Index>(i));
  });
  weight_.resize(cloud_.size());
  parallel_for(static_cast<std::ptrdiff_t>(cloud_.size()),
               [&](std::ptrdiff_t k) { weight_[k] = stage.surface[cloud_[k]]; });
  cloud_power_.assign(cloud_.size(), 0.0);
  const laser::PointCloud cloud = cloud_at(stage.patch->x, nullptr);
  undeposited_ += laser::deposit(hits_, groups_, cloud, weight_.data(), kDepositRadius * constants_.spacing,
                                 cloud_power_.data());
  for (std::size_t k = 0; k < cloud_.size(); ++k) power[cloud_[k]] = cloud_power_[k];
}

void LaserCoupling::book(double dt) {
  budget_.in += dt * ledger_.in;
  budget_.absorbed += dt * ledger_.absorbed;
  budget_.escaped += dt * ledger_.escaped;
  budget_.residual += dt * ledger_.residual;
  budget_.dropped += dt * ledger_.dropped;
}

LaserState LaserCoupling::state() const {
  return {ledger_.in, ledger_.absorbed, ledger_.escaped, ledger_.residual};
}

void LaserCoupling::archive(Archive& a) {
  a.value("laser/in", budget_.in);
  a.value("laser/absorbed", budget_.absorbed);
  a.value("laser/escaped", budget_.escaped);
  a.value("laser/residual", budget_.residual);
  a.value("laser/dropped", budget_.dropped);
  a.value("laser/worst", budget_.worst);
  a.value("laser/traces", budget_.traces);
  a.value("laser/rays", budget_.rays);
  a.value("laser/dropped_rays", budget_.dropped_rays);
  ray_count_.archive(a);
  a.value("laser/ledger_in", ledger_.in);
  a.value("laser/ledger_absorbed", ledger_.absorbed);
  a.value("laser/ledger_escaped", ledger_.escaped);
  a.value("laser/ledger_residual", ledger_.residual);
  // The region of the next trace depends on how deep light went: the hits are part of the state.
  std::vector<double> hits;
  for (const laser::Hit& h : hits_)
    hits.insert(hits.end(), {h.position[0], h.position[1], h.position[2], h.power});
  a.values("laser/hits", hits);
  if (a.loading()) {
    hits_.clear();
    for (std::size_t k = 0; k + 3 < hits.size(); k += 4)
      hits_.push_back({Vec3(hits[k], hits[k + 1], hits[k + 2]), hits[k + 3]});
    group_hits();
  }
  stale_ = true;
}

}  // namespace meltray::scene
