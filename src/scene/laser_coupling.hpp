// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "meltray/laser/laser.hpp"
#include "meltray/particles/patch.hpp"
#include "meltray/scene/simulation.hpp"
#include "meltray/terms/stage.hpp"

namespace meltray::scene {

/// Keeps the rays' hits on the surface up to date and turns them into power per particle.
class LaserCoupling {
 public:
  LaserCoupling(const Scene& scene, const terms::SceneConstants& constants);

  /// True where a trace is due: the interval has passed, the surface or the beam has moved, the beam went on
  /// or off, or none was made.
  bool due(double t) const;
  /// Reconstructs the surface around the beam and traces the rays.
  void trace(double t, const PatchSelector& selector, const Particles& particles);
  /// Power per patch particle [W]; hits sit on the surface and pass to the particles that are there now.
  void deposit(const terms::Stage& stage, std::vector<double>& power);
  /// Books the energy of a step of length dt.
  void book(double dt);

  /// Resting particles that hits may heat: they belong in the patch.
  const std::vector<Index>& lit() const { return lit_; }
  const laser::Tracer& tracer() const { return tracer_; }
  const laser::Beam& beam() const { return beam_; }
  const LaserBudget& budget() const { return budget_; }
  LaserState state() const;
  double undeposited() const { return undeposited_; }  ///< [W] at the last deposit
  void add_motion(double m) { motion_ += m; }
  /// Saving and loading force a new trace at the next step.
  void archive(Archive& a);

 private:
  void group_hits();
  laser::PointCloud cloud_at(const Components& x, const std::uint8_t* liquid);
  laser::Box region(double t, const Particles& particles, const PatchSelector& selector) const;

  const Scene& scene_;
  const terms::SceneConstants& constants_;
  laser::Beam beam_;
  laser::Tracer tracer_;
  laser::RayCount ray_count_;
  std::vector<laser::Hit> hits_;
  std::vector<laser::HitGroup> groups_;  ///< of hits_
  laser::Ledger ledger_;
  LaserBudget budget_;
  std::vector<Index> lit_;
  Vec3 traced_focus_ = Vec3::Zero();  ///< of the last trace [m]
  double next_trace_ = 0, motion_ = 0, undeposited_ = 0;
  double lost_ = 0;  ///< power of hits at no finite place [W]
  bool stale_ = true;
  std::vector<double> weight_, cloud_power_, cx_[3];
  std::vector<Index> cloud_;
  std::vector<std::uint8_t> liquid_;  ///< of the cloud of a trace
};

}  // namespace meltray::scene
