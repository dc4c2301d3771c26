// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/core/vec.hpp"

/// The pair loops of AcousticPass. They are compiled once for every instruction set that the program can
/// choose from when it starts, so this header and acoustic_kernel.cpp use nothing that the linker might share
/// with the rest of the program.
namespace meltray::terms {

/// Slots of an octet, and rows of a group: those of sph/clusters.hpp, which this header keeps away from.
constexpr Index kOctetSlots = 8, kRowsOfGroup = 2;

/// Fields of a cluster set, one entry per slot; empty slots have no volume and are far away.
struct AcousticFields {
  const double *x[3], *v[3];
  const double* density;   ///< [kg/m^3]
  const double* volume;    ///< m / rho [m^3]
  const double* pressure;  ///< [Pa]
  const double* drag;      ///< 1 where it takes part in artificial viscosity, else 0; of walls only
  const double* excess;    ///< rho - rho_0(T) [kg/m^3]; of melt only
  double* gradient[3];  ///< renormalised gradient of the excess [kg/m^4]; of melt, with Antuono's diffusion
};

/// A ClusterList.
struct OctetLists {
  const Index *start, *octet;
};

/// What the loops need to know; see weakly_compressible.hpp for the terms.
struct AcousticArguments {
  AcousticFields melt, wall;
  OctetLists melt_melt, melt_wall, wall_melt;  ///< rows_sources
  double smoothing;                            ///< h [m]
  double period[3], inverse_period[3];         ///< 0 in directions that are not periodic
  double continuity;                           ///< 1 / second moment of the lattice
  double diffusion;                            ///< delta h c / second moment; 0: none
  double own_pressure;                         ///< 1: sum form, -1: difference form
  double inverse_w;                            ///< 1 / W(dx) of artificial stress; 0: none
  double stress_tension, stress_pressure;      ///< its shares of a negative pressure, and of a positive sum
  bool gradients;                              ///< Antuono's diffusion
  double viscosity;                            ///< 2 alpha c h times the second moment; 0: none
  double gravity;                              ///< downwards [m/s^2]
  double *density_rate, *force[3];             ///< per slot of melt; see AcousticPass
  double* moment[6];                           ///< per slot of melt
  double* wall_pressure;                       ///< per slot of wall
};

/// Loops over the groups of rows [begin, end).
struct AcousticKernel {
  const char* instructions;  ///< name of the instruction set
  /// wall_pressure: Adami et al. 2012, eq. 27.
  void (*extrapolate)(const AcousticArguments&, Index begin, Index end);
  /// gradient (not renormalised yet) and moment of the melt.
  void (*excess_gradient)(const AcousticArguments&, Index begin, Index end);
  /// density_rate, and the force of pressure and artificial viscosity.
  void (*rates)(const AcousticArguments&, Index begin, Index end);
};

/// The loops for a dimension and a kernel, for the best instructions of this processor (or those that the
/// environment variable MELTRAY_INSTRUCTIONS names, for comparisons).
const AcousticKernel& acoustic_kernel(int dim, bool cubic_spline);

}  // namespace meltray::terms
