// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/terms/term.hpp"

namespace meltray::terms {

/// Particle shifting as a transport velocity, dx/dt = v + du, after Lind et al. 2012 in the form of Skillen
/// et al. 2013: du_i = -C h |v_i| sum_j V_j (1 + 0.2 max((W_ij/W(dx))^4 - 1, 0)) grad W_ij. The push in the
/// bracket, theirs less its value at a spacing, keeps pairs from clumping; it is zero from a spacing on, for
/// there it would shear a lattice along its columns. The velocity carried along gets the convective
/// correction du.grad v; enthalpy stays with its particle, so that energy is conserved exactly. |du|
/// saturates at a fifth of the speed: next to a void or in a crushed pair the sum alone would outrun the
/// flow. Surface particles are not shifted: their colour gradient points into the material.
struct Shifting {
  double coefficient = 0;
  double least_speed = 0;  ///< stands in for |v| where that is smaller (stagnation points) [m/s]
  /// Adds du to `transport` and du.grad v to `acceleration` of moving particles.
  void add_rates(const Stage& stage, const MutField& transport, const MutField& acceleration) const;
};

}  // namespace meltray::terms
