// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/solve/conjugate_gradient.hpp"
#include "meltray/terms/term.hpp"

namespace meltray::terms {

/// Heat conduction, paper Eq. (4) first term, in enthalpy form after Cleary & Monaghan 1999:
///   m_i dh_i/dt = sum_j k_ij (T_i - T_j),  k_ij = V_i V_j 4 l_i l_j / (l_i + l_j) F_ij <= 0,
/// divided by the kernel's second moment on a lattice. Pairs exchange what one loses and the other gains;
/// only pairs with both sides in `stage.heat` count, plus isothermal walls with the temperature extrapolated
/// so that the profile meets the wall value at the face.
class ConductionOperator {
 public:
  void assemble(const Stage& stage);
  /// Adds to dh/dt of heated particles; returns the power that walls put in [W].
  double add_heating(const Stage& stage, double* heating) const;
  /// Solves (I - gamma J) x = b for the heated particles with J = d(dh/dt)/dh frozen at the stage, plus
  /// `local` = d(power of local losses)/dT <= 0 [W/K] per particle (may be null). One entry per patch
  /// particle; x is overwritten. Returns iterations, or -1 without convergence (relative residual
  /// `tolerance`).
  int solve(const Stage& stage, double gamma, const double* local, const double* b, double* x,
            double tolerance, int max_iterations) const;
  /// Largest row sum of -J [1/s].
  double rate(const Stage& stage) const;

 private:
  double row_sum(const sph::PairList& pairs, Index i) const;

  std::vector<double> k_;  ///< per pair; 0 where the pair does not exchange heat
  std::vector<double> conductivity_, wall_slope_, wall_power_;
  mutable std::vector<double> capacity_, dt_;
  mutable solve::CgVectors<1> vectors_;
};

/// Pair coefficient k_ij of the header comment [W/K].
inline double conduction_coefficient(double vi, double vj, double li, double lj, double f) {
  const double sum = li + lj;
  return sum > 0 ? vi * vj * 4 * li * lj / sum * f : 0.0;
}

}  // namespace meltray::terms
