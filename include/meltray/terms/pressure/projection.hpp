// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "meltray/solve/conjugate_gradient.hpp"
#include "meltray/solve/direct.hpp"
#include "meltray/terms/term.hpp"

namespace meltray::terms {

/// How the surface pressure q (recoil + sigma kappa) meets the pressure field.
///   csf: the continuum surface force 2 q grad c / rho acts on the particles of the surface layer, against
///        the surface part 2 p grad c / rho of the pressure gradient of Eq. (3), both scaled so that the
///        gradient of a pressure that falls linearly to q on a flat face is exact in the outermost layer;
///   pressure: q is only the boundary value of p, and the gradient is the renormalised difference form.
enum class SurfaceEntry { csf, pressure };

/// How the Poisson equation is solved: to a tolerance by conjugate gradients, or exactly by sparse Cholesky
/// factors (CHOLMOD), which small scenes can afford.
enum class PressureSolver { conjugate_gradients, cholesky };

struct ProjectionOptions {
  SurfaceEntry entry = SurfaceEntry::csf;
  PressureSolver solver = PressureSolver::conjugate_gradients;
  double tolerance = 1e-3;
  int max_iterations = 500;
};

/// ISPH pressure: the Poisson equation (6) of the paper on the liquid particles and their solid neighbours,
///   sum_j a_ij (p_i - p_j) + g_i (p_i - q_i) = -V_i S_i,  a_ij = -(1/m_i + 1/m_j) V_i V_j F_ij,
/// where S is what the divergence of grad p / rho has to be. At a free surface the missing part of the kernel
/// is filled by particles of pressure q ("ghost" diagonal, Nair & Tomar 2014): g_i = surface_i * (full sum of
/// a - actual sum), or as much more as puts q on the face of a flat surface, half a spacing above its
/// outermost layer, where the surface force has it: |sum_j a_ij x_ij| over that half spacing. Solid particles
/// are rows with zero velocity (no flow through them) and infinite mass, with m = rho in the melt: they do
/// not pass pressure on to each other, and a linear pressure is exact on a lattice up to walls and corners.
/// Deeper solid is left out (zero normal derivative). With q uniform, p = q is an exact rest state of both
/// surface entries.
class Projection {
 public:
  /// Rows, matrix and ghost diagonal at the stage's geometry and surface.
  void assemble(const Stage& stage);
  Index rows() const { return matrix_.rows(); }
  /// div u = sum_j V_j (u_j - u_i).grad W_ij for every row; `u` has one entry per patch particle.
  void divergence(const Stage& stage, const ConstField& u, std::vector<double>& out) const;
  /// -d_a v_b d_b v_a: what the motion of Lagrangian particles adds to the rate of change of div v.
  void divergence_rate(const Stage& stage, const ConstField& v, std::vector<double>& out) const;
  /// Relative density error driving the drift correction: fill - 1, only compression near a free surface and
  /// in dummies.
  void compression(const Stage& stage, std::vector<double>& out) const;
  /// Solves for p with div(grad p / rho) = source (one entry per row), warm-started from and stored to the
  /// patch's pressure. Components without a free surface get the mean-zero solution.
  solve::SolveReport solve(const Stage& stage, const std::vector<double>& source,
                           const ProjectionOptions& options);
  /// Adds -grad p / rho (and the surface force of the csf entry) of moving particles.
  void add_acceleration(const Stage& stage, SurfaceEntry entry, const MutField& acceleration) const;
  const solve::SymmetricMatrix& matrix() const { return matrix_; }
  Index floating() const { return floating_; }

 private:
  template <int D>
  double sliding(const Stage& stage, Index i, const ConstField& u) const;
  const double* partner_volume(const Stage& stage, Index i) const;
  solve::SolveReport solve_exactly();

  std::vector<Index> row_of_, particle_of_;  ///< patch index <-> row
  solve::SymmetricMatrix matrix_;
  std::vector<double> solved_volume_;  ///< per patch particle: 0 without a row
  std::vector<double> melt_volume_;    ///< per patch particle: 0 without a row and of what is fixed
  std::vector<double> ghost_, anchor_, rhs_, x_;
  std::vector<Index> group_, scratch_;
  std::vector<double> group_sum_, group_share_;
  Index floating_ = 0;
  solve::ConjugateGradient cg_;
  std::optional<solve::DirectSolver> direct_;  ///< once asked for
};

}  // namespace meltray::terms
