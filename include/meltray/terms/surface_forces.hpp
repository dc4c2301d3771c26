// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/core/constants.hpp"
#include "meltray/terms/term.hpp"

namespace meltray::terms {

/// Surface tension (normal part), continuum surface force: pressure jump sigma(T) kappa. The curvature of a
/// particle is the least-squares slope of its neighbours' normals over their offsets in the tangent plane,
///   kappa_i = (D-1) sum_j w_ij (n_j - n_i).t_ij / sum_j w_ij |t_ij|^2,
/// which is exact where the normals are those of a sphere, unlike the usual sum over all offsets, which
/// counts the offset along the normal as well (1.4 times too large on a thin band).
struct SurfaceTension {
  double ramp = 20;  ///< [K] above melting over which tension sets in, so that a fresh particle is not kicked
  /// sigma_i kappa_i [Pa] of liquid surface particles, 0 elsewhere; one entry per patch particle.
  void pressure(const Stage& stage, std::vector<double>& out) const;
  double activation(const Stage& stage, Index i) const;

 private:
  void smooth_normals(const Stage& stage) const;
  mutable Components smooth_, previous_;
};

/// Wetting after Breinlinger et al. 2013: near the triple line the normal is turned towards
///   n_tp = sin(theta) t_w - cos(theta) n_w,  t_w the part of n orthogonal to the wall normal n_w,
/// over a ramp in the wall colour. Where the surface is parallel to the wall, as that of a film which covers
/// its solid, there is no triple line, and n stays. Rewrites stage.normal of liquid surface particles, and
/// stage.wall_normal, which the surface tension keeps while it averages normals.
struct Wetting {
  double contact_angle_deg = 10;
  void turn_normals(Stage& stage) const;
};

enum class RecoilOnset { smooth, cutoff, ambient };

/// Recoil pressure p_r = C_r p_sat(T) of evaporating liquid (Anisimov 1968: C_r = 0.54), with a named onset:
/// smooth = at all temperatures; cutoff = only above T_b; ambient = max(0, C_r p_sat - p_0).
struct Recoil {
  RecoilOnset onset = RecoilOnset::smooth;
  double coefficient = 0.54;
  double prescribed = 0,
         prescribed_ramp = 0;    ///< > 0: pressure [Pa] instead of that, reached after a linear start [s]
  double prescribed_radius = 0;  ///< > 0: of a spot, exp(-2 r^2 / radius^2) [m]
  /// [Pa] at temperature [K], time t [s] and squared distance r2 from the axis x = y = 0 [m^2].
  double pressure(const Material& m, double temperature, double t, double r2 = 0) const;
};

/// The average of `pressure` over the melt at the surface near each particle (weights surface_j W_ij), so
/// that one overheated particle does not pull its neighbours apart; one entry per patch particle. Dry solid
/// has no part in it: what it took of recoil and tension beside a line of contact nothing would give back.
void average_over_surface(const Stage& stage, const std::vector<double>& pressure,
                          std::vector<double>& average);

/// What the outermost layer lacks of the slope of the recoil along the surface. On a flat face its sums have
/// 0.78 (2-D) or 0.79 (3-D) of the second moment of a full kernel, and its melt would take that share of the
/// acceleration. Adds -(1 - lattice.face_moment) exposure (I - n n) grad q / rho to melt at the surface, q
/// being the averaged `recoil` and its gradient that by least squares in the plane of the surface. Not so for
/// sigma kappa: at a line of contact that is a force spread over the kernel, whose slope would hold the line.
void add_recoil_along_surface(const Stage& stage, const std::vector<double>& recoil,
                              const MutField& acceleration);

/// Marangoni stress as a body force: a = (d sigma/dT / rho) 2 (-n.grad c) (I - n n) grad T, grad T
/// renormalised, n the mean normal of the surface around a particle. Pairs above a plane inside the liquid
/// cancel in the sum of V grad c over all particles above it, whatever their order, and those across it leave
/// half the second moment of a full lattice: divided by that, the force per area is d sigma/dT grad T.
struct Marangoni {
  void add_acceleration(const Stage& stage, const MutField& acceleration) const;
};

/// Gravity with the Boussinesq approximation, paper Eq. (8): a = g (1 - beta (T - T_0)); beta = 0: plain
/// gravity.
struct Buoyancy {
  bool gravity = true, buoyant = false;
  double g = constants::standard_gravity;  ///< [m/s^2], acts along -z
  void add_acceleration(const Stage& stage, const MutField& acceleration) const;
};

}  // namespace meltray::terms
