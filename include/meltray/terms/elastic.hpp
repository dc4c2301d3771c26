// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "meltray/terms/term.hpp"

namespace meltray::terms {

/// Thermoelastic solid, paper Eq. (9): sigma = -p I + S. Of particle i with neighbours j in the solid,
///   grad v = sum_j V_j (v_j - v_i) (L_i grad W_ij)^T, L_i the renormalisation of the kernel's gradient,
///   p = K (rho / rho_0(T) - 1), which is Eq. (7) with c_0^2 = K / rho_0; d rho/dt = -rho tr D,
///   dS/dt = 2 G (D - tr D I / 3) + Omega S - S Omega, the rate of Jaumann, as in Gray et al. 2001,
///   rho_i dv_i/dt = sum_j V_j (sigma_i L_i + sigma_j L_j + (R_i + R_j) f^4) grad W_ij,
/// D and Omega the symmetric and the skew part of grad v. Without R the force does the work that the stress
/// takes up (Bonet & Lok 1999), so that energy is kept, and so are both momenta, because grad v is exact for
/// a rigid motion. R is the artificial stress of Gray et al. 2001: -epsilon times the tensile
/// principal stresses, f = W_ij / W(dx). Two dimensions are plane strain: S_yy = -S_xx - S_zz.
///
/// Walls hold the solid: behind a no-slip face the velocity goes on linearly so that it vanishes on the face,
/// behind a slip face only its normal part, and the stress is that of particle i (with the shear along a slip
/// face turned round). Resting solid counts as a body at rest with the stress of particle i. Melt acts with
/// its pressure and artificial viscosity, each pair with what the melt feels in the summed form of Eq. (3).
struct ElasticSolid {
  double bulk_modulus = 0, shear_modulus = 0;  ///< K, G [Pa]
  double expansion = 0;                        ///< linear, of rho_0(T) [1/K]
  double viscosity = 1;                        ///< alpha of the artificial viscosity, with the speed of sound
  double artificial_stress = 0.3;              ///< epsilon
  double melt_drag = 0;                        ///< alpha c of the melt's artificial viscosity [m/s]
  double gravity = 0;                          ///< downwards [m/s^2]

  /// rho_m exp(-3 alpha (T - T_m)), rho_m the scene's density, so that melting does not change it [kg/m^3].
  double reference_density(const SceneConstants& constants, double temperature) const;
  /// K (rho / rho_0 - 1) [Pa].
  double pressure(double density, double reference) const;
  /// Of longitudinal waves, sqrt((K + 4 G / 3) / rho) [m/s].
  double sound_speed(double density) const;
  /// The same with what the artificial viscosity adds to it in the limit of a step, Monaghan 1989 [m/s].
  double acoustic_speed(double density) const { return sound_speed(density) * (1 + 0.6 * viscosity); }
  /// Volumes of the elastic particles from their densities.
  void update(Stage& stage) const;
  /// d rho/dt, dS/dt and acceleration of the elastic particles.
  void add_rates(const Stage& stage, const Rates& rates) const;

 private:
  template <int D>
  void add_stress_rates(const Stage& stage, const Rates& rates) const;
  void weigh(const Stage& stage) const;
  template <int D>
  void add_acceleration(const Stage& stage, const MutField& acceleration) const;

  mutable std::vector<double> solid_volume_;       ///< 0 for melt [m^3]
  mutable std::vector<double> own_weight_, drag_;  ///< see weigh() [m^3], [kg m/s]
  mutable std::vector<double> tensors_;            ///< sigma L and R in turn, in padded columns
};

}  // namespace meltray::terms
