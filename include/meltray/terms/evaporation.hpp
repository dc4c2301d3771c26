// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/terms/term.hpp"

namespace meltray::terms {

/// Evaporation loss, part of q_r in paper Eq. (4): mass flux after Hertz, Knudsen and Langmuir,
///   m'' = (1 - beta_r) p_sat(T) sqrt(M / (2 pi R T)) [kg/(m^2 s)], q = -L_v m'' per free-surface area,
/// and radiation q = -eps sigma_SB (T^4 - T_a^4). Both act on the particle's own surface area and are local:
/// they have no neighbours. The mass is counted, not removed.
///
/// T is that of the particle or, with `at_face`, of the face of liquid, T_s: what light brings and the losses
/// leave is conducted over half the layer that the particle stands for,
///   P / A - q(T_s) = 2 lambda (T_s - T) / d,  d = min(V / A, spacing).
struct SurfaceLosses {
  bool evaporation = false, radiation = false;
  double coefficient = 0.82;         ///< 1 - beta_r
  double ambient_temperature = 300;  ///< [K]
  bool at_face = false;

  /// Mass flux [kg/(m^2 s)] and its derivative with respect to T.
  double mass_flux(const Material& m, double temperature) const;
  double mass_flux_slope(const Material& m, double temperature) const;
  /// Fills stage.face_temperature from the temperatures and surface of the stage; light: power that each
  /// particle absorbs [W], empty in the dark.
  void find_faces(Stage& stage, const std::vector<double>& light) const;
  /// Adds to dh/dt and to the crossings (as positive losses).
  void add_heating(const Stage& stage, double* heating, Crossings& crossings) const;
  /// d(power)/dT of each particle [W/K], <= 0, written to `slope` (one entry per patch particle).
  void slope(const Stage& stage, double* slope) const;
  /// Largest |d(dh/dt)/dh| [1/s].
  double rate(const Stage& stage) const;

 private:
  /// Heat that an area radiates [W].
  double radiated(const Material& m, double area, double temperature) const;
  /// Heat that the face of a particle loses [W/m^2], and its derivative with respect to T_s.
  double flux(const Stage& stage, Index i, double temperature) const;
  double flux_slope(const Stage& stage, Index i, double temperature) const;
  double slope_of(const Stage& stage, Index i) const;
  double temperature_of_vapour(const Material& m, double absorbed) const;
};

}  // namespace meltray::terms
