// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/solve/conjugate_gradient.hpp"
#include "meltray/terms/term.hpp"

namespace meltray::terms {

/// Which viscous terms an operator contains.
struct ViscousChoice {
  bool physical = false, interface = false;
  bool any() const { return physical || interface; }
};

struct InterfaceViscosityParameters {
  double free = 1, solid = 1;  ///< alpha_LG at the free surface, alpha_SL at the solid
  double reference_speed = 0;  ///< c [m/s]
  double ramp = 50;            ///< [K] above melting over which alpha_SL fades out
};

/// How an implicit solve ended.
struct ViscousSolve {
  int iterations = 0;
  bool converged = false;
  Vec3 impulse = Vec3::Zero();  ///< gamma times the total viscous force [kg m/s]
};

/// Viscous accelerations a_i = (1/m_i) sum_j [c_ij v_ij' + d_ij (v_ij.x_ij) x_ij] with symmetric c, d <= 0,
/// so that the operator -M is symmetric positive semi-definite and momentum is conserved between moving
/// particles.
///
/// Physical viscosity, paper Eq. (3) second term in the form of Morris et al. 1997:
///   c_ij = 2 V_i V_j mu_ij F_ij, mu_ij the harmonic mean, walls with the antisymmetric extrapolation of
///   Morris 1997 (no slip). Melt clings to the face of its own solid in the same way; where that lies is told
///   by the solid's colour (sph::FaceDistance).
/// Interface viscosity, Meier et al. 2021: d_ij = alpha_ij V_i V_j rho h c F_ij / (r^2 + 0.01 h^2), for
/// approach
///   and separation, with alpha_i = |grad c_i| h alpha_LG + ramp(T_i) alpha_SL. The published form uses
///   alpha_i alone; between melt particles alpha_ij = (alpha_i + alpha_j)/2 is used here because it conserves
///   momentum and makes the implicit operator symmetric. Against a solid neighbour it is the melt's own
///   alpha_i; dummies behind the faces of the box have alpha_j = alpha_SL.
class ViscousOperator {
 public:
  /// Evaluates the coefficients at the stage's geometry, temperatures and surface.
  void assemble(const Stage& stage, ViscousChoice choice, const InterfaceViscosityParameters& interface);
  /// Adds accelerations of moving particles; `v` are velocities of all patch particles.
  void add_acceleration(const Stage& stage, const ConstField& v, const MutField& acceleration) const;
  /// Solves x - gamma A(x) = b for the velocities x of the moving particles: x and b have one entry per patch
  /// particle; x holds the start vector, and resting neighbours keep what x says. Stops when the residual has
  /// fallen by `tolerance`, or after so many iterations.
  ViscousSolve solve(const Stage& stage, double gamma, const ConstField& b, const MutField& x,
                     double tolerance, int max_iterations) const;
  /// Largest row sum of -A [1/s]: an explicit step is stable below about 2 / rate.
  double rate(const Stage& stage) const { return rate(stage, choice_); }
  /// The same of a part of what is assembled.
  double rate(const Stage& stage, ViscousChoice part) const;

 private:
  template <int D, bool Physical, bool Interface>
  std::array<double, D> row(const Stage& stage, Index i, const std::array<const double*, D>& u) const;
  template <int D, class F>
  void with_row(F&& f) const;
  template <int D>
  ViscousSolve solve_in(const Stage& stage, double gamma, const ConstField& b, const MutField& x,
                        double tolerance, int max_iterations, solve::CgVectors<D>& vectors) const;

  ViscousChoice choice_;
  std::vector<float> c_, d_;           ///< per pair, rounded alike for (i, j) and (j, i)
  std::vector<double> c_sum_, d_sum_;  ///< sum_j -c_ij and sum_j -d_ij r_ij^2 of each row
  std::vector<double> alpha_, mu_;
  mutable solve::CgVectors<2> vectors_2d_;
  mutable solve::CgVectors<3> vectors_3d_;
};

}  // namespace meltray::terms
