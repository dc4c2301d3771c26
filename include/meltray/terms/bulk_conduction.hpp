// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/particles/patch.hpp"
#include "meltray/terms/stage.hpp"

namespace meltray::terms {

/// Heat conduction among resting particles away from the melt, at an interval of its own. Every pair of
/// particles belongs either to the state vector (both sides marked in `in_state`) or to this operator, so
/// heat is conserved exactly across the boundary between them. Particles at rest thermally are not looked at.
class BulkConduction {
 public:
  /// Finds the resting particles that differ from `rest_temperature` by more than 0.05 K, their
  /// neighbours and their pair coefficients. Call again before heat has travelled a support radius.
  void build(const SceneConstants& constants, PatchSelector& selector, const Particles& particles,
             double rest_temperature);
  /// Exchanges heat over `dt` by explicit steps below the stability limit. `in_state` has one entry per
  /// particle of the store. Updates enthalpy and temperature of resting particles.
  void exchange(const SceneConstants& constants, double dt, const std::vector<std::uint8_t>& in_state,
                Particles& particles);
  std::size_t rows() const { return patch_.global.size(); }
  std::size_t bytes() const;

 private:
  template <class Rests>
  void assemble(const SceneConstants& constants, const sph::PairList& pairs, bool elastic, Rests&& rests);

  Patch patch_;
  /// Row i holds the entries from start_[i] to start_[i + 1].
  std::vector<Index> start_, neighbour_;
  std::vector<float> k_;
  std::vector<double> lambda_, missing_, temperature_, gain_;
  std::vector<std::uint8_t> at_rest_, skip_;
  double rate_ = 0;
};

}  // namespace meltray::terms
