// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/terms/term.hpp"

namespace meltray::terms {

/// Keeps melt at the free surface from overlapping with melt and with solid. A projection holds the
/// divergence at zero as its sums see it; in a film of one or two layers, whose pressure is that of the
/// surface, they see little, and what presses on the film pushes its particles into each other: the melt
/// loses volume. Inside, that is the task of the shifting.
///
/// Pairs nearer than `share` spacings move apart in the time `parting`. Their velocities stay: collisions as
/// of Kruisbrink et al. 2018, which stop such pairs, take a quarter of its energy out of a flow that has to
/// stretch, for there particles come near each other in one direction as they part in another.
struct LeastDistance {
  double share = 0;    ///< of the spacing; 0: none
  double parting = 0;  ///< [s]
  /// Displacement [m] of each moving particle over a step dt [s], from the positions in the patch: those at
  /// the end of the step, while the list is that of its start. A particle of melt takes half of its share in
  /// each pair, since it mostly has several.
  void displace(const Stage& stage, double dt, const MutField& displacement) const;
};

}  // namespace meltray::terms
