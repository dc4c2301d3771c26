// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "meltray/solve/conjugate_gradient.hpp"
#include "meltray/terms/term.hpp"

namespace meltray::terms {

/// Heat conduction, paper Eq. (4) first term, in enthalpy form after Cleary & Monaghan 1999:
///   m_i dh_i/dt = sum_j k_ij (T_i - T_j),  k_ij = V_i V_j 4 l_i l_j / (l_i + l_j) F_ij <= 0,
/// divided by the kernel's second moment on a lattice. A particle of a free surface lacks the partners of the
/// layers outside, which carry a fifth of the heat along a flat face: pairs within the outermost layer take
/// it over (along_surface()). Pairs exchange what one loses and the other gains; only pairs with both sides
/// in `stage.heat` count, plus isothermal walls with the temperature extrapolated so that the profile meets
/// the wall value at the face.
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
  void find_missing_layers(const Stage& stage);
  double exchange(const sph::PairList& pairs, Index i, const double* temperature) const;

  std::vector<float> k_;  ///< per pair, rounded alike for (i, j) and (j, i); 0 where no heat is exchanged
  std::vector<double> conductivity_, missing_, row_sum_, wall_slope_, wall_power_;
  mutable std::vector<double> capacity_, dt_;
  mutable solve::CgVectors<1> vectors_;
};

/// True where a particle has so many neighbours, none of them a dummy, that it lacks nothing: most do, and
/// their Shepard sum need not be asked for. One of a flat face has little more than half of a full lattice's.
inline bool surrounded(const sph::PairList& pairs, Index i, const sph::LatticeSums& lattice) {
  return pairs.count(i) >= 0.9 * lattice.neighbours && !pairs.next_to_wall()[i];
}

/// What a particle lacks for conduction along the surface, over what one of a flat face lacks: 0 inside, 1 on
/// a flat face, more in films, which conduct as in dense metal too. `shepard`: over that of a full lattice.
inline double missing_layers(double shepard, const sph::LatticeSums& lattice) {
  constexpr double kDisorder = 0.05;  // what a Shepard sum may lack anywhere in a melt
  return std::clamp((1 - kDisorder - shepard) / (1 - kDisorder - lattice.face_fill), 0.0,
                    (1 - lattice.layer_moment) / (1 - lattice.face_moment));
}

/// Factor on k_ij for two particles that lack `a` and `b`: pairs across layers keep theirs.
inline double along_surface(double a, double b, const sph::LatticeSums& lattice) {
  return 1 + std::min(a, b) * (1 - lattice.face_moment) / lattice.layer_moment;
}

/// Pair coefficient k_ij of the header comment without along_surface() [W/K].
inline double conduction_coefficient(double vi, double vj, double li, double lj, double f) {
  const double sum = li + lj;
  return sum > 0 ? vi * vj * 4 * li * lj / sum * f : 0.0;
}

}  // namespace meltray::terms
