// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/terms/term.hpp"

namespace meltray::terms {

/// Artificial viscosity of Monaghan 1992 between particles that approach each other (v_ij.x_ij < 0):
///   a_i = sum_j m_j alpha c h (v_ij.x_ij) / (rho_ij (r^2 + 0.01 h^2)) grad W_ij,  rho_ij the mean density.
/// Not smooth in v, so explicit only. Resting solid and no-slip walls take part, slip walls do not.
struct ArtificialViscosity {
  double alpha = 0;
  double sound_speed = 0;  ///< c [m/s]
  void add_acceleration(const Stage& stage, const MutField& acceleration) const;

 private:
  mutable std::vector<double> mass_;  ///< 0 where a particle exerts no drag [kg]
};

}  // namespace meltray::terms
