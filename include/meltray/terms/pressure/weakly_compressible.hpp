// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/terms/term.hpp"

/// Pressure of weakly compressible SPH: the density is a field of the state, and pressure follows from it.
/// Sums over neighbours are divided by the kernel's second moment on a lattice, as in the projection, so that
/// gradients of linear fields and the speed of sound come out right at the given h / dx. Everything here
/// reads and writes Patch::density and Stage::excess, which only such scenes have. The sums over pairs are
/// made in one pass, acoustic_pass.hpp:
///   continuity, paper Eq. (2): d rho_i/dt = rho_i sum_j V_j (v_i - v_j).grad W_ij (the density of a particle
///   that flies alone returns to rho_0(T) within the time sound takes over a smoothing length);
///   pressure of walls and of resting solid next to the melt, Adami et al. 2012, eq. 27:
///   p_w = sum_f (p_f + rho_f g.(x_w - x_f)) W_wf / sum_f W_wf;
///   and the terms below.
namespace meltray::terms {

/// What becomes of negative pressure:
///   full: it pulls neighbours together like any other pressure;
///   none: it counts as zero, the melt tears without resistance;
///   artificial_stress: it acts, with the repulsion of Monaghan 2000 against the pairing that it causes.
enum class Tension { full, none, artificial_stress };

/// Linear equation of state, paper Eq. (5) and, with expansion, Eq. (7): p = c^2 (rho - rho_0(T)).
struct EquationOfState {
  double sound_speed = 0;  ///< c [m/s]
  bool expansion = false;  ///< rho_0 follows the density of the melt over temperature
  Tension tension = Tension::full;
  double gravity = 0;  ///< downwards [m/s^2], for the pressure behind walls
  /// Share of rho_0 by which melt can be thinner than it. A particle beyond has been torn off: its tension
  /// grows no further, and its density returns like that of one that flies alone. Without a bound a single
  /// particle of spray, thinned to a quarter, was flung away by 1e8 Pa of tension.
  double tear = 0.05;

  double reference_density(const SceneConstants& constants, double temperature) const;
  /// Of an excess density rho - rho_0 over a reference density rho_0 [kg/m^3].
  double pressure(double excess, double reference) const;
  /// Volumes, excess densities rho - rho_0(T) and pressures of moving particles from density and temperature.
  void update(Stage& stage) const;
};

enum class DiffusionForm { molteni_colagrossi, antuono };

/// Density diffusion, d rho_i/dt = delta h c sum_j V_j psi_ij.grad W_ij, among moving particles:
///   Molteni & Colagrossi 2009: psi_ij = 2 (e_j - e_i) x_ji / r^2,
///   Antuono et al. 2010: the same less the mean of the renormalised gradients of e along x_ji,
/// which leaves linear profiles and the free surface alone. What diffuses is e = rho - rho_0(T), so that a
/// thermal profile of the density is not smeared.
struct DensityDiffusion {
  DiffusionForm form = DiffusionForm::antuono;
  double coefficient = 0;  ///< delta; 0: none
  bool needs_gradients() const { return coefficient > 0 && form == DiffusionForm::antuono; }
};

/// The pressure gradient of Eq. (3), first term, and how the surface pressure q (recoil and surface tension)
/// meets it as a continuum surface force:
///   sum: a_i = -sum_j m_j (p_i + p_j) / (rho_i rho_j) grad W_ij + 2 q_i grad c_i / rho_i, as published.
///   Pairs
///        exchange what one loses and the other gains. Under a uniform pressure disorder is felt as a force.
///   difference: a_i = -sum_j m_j (p_j - p_i) / (rho_i rho_j) grad W_ij - 2 s_i (p_i - q_i) grad c_i / rho_i,
///        s the surface weight: the same on the surface, but no force from disorder inside.
/// A body of uniform pressure q is exactly at rest under both.
enum class GradientForm { sum, difference };

/// Where tension is handled by artificial stress, the sum over pairs has the repulsion R_ij f^4 of Monaghan
/// 2000 (the difference form needs its part for negative pressures only).
struct PressureForce {
  GradientForm form = GradientForm::difference;
  /// What stands with grad c above.
  void add_surface_force(const Stage& stage, const MutField& acceleration) const;
};

/// Artificial viscosity of Monaghan 1992 between particles that approach each other (v_ij.x_ij < 0):
///   a_i = sum_j m_j alpha c h (v_ij.x_ij) / (rho_ij (r^2 + 0.01 h^2)) grad W_ij,  rho_ij the mean density.
/// Not smooth in v, so explicit only. Resting solid and no-slip walls take part, slip walls do not.
struct ArtificialViscosity {
  double alpha = 0;  ///< 0: none
};

}  // namespace meltray::terms
