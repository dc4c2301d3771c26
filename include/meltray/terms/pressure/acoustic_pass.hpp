// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "meltray/sph/clusters.hpp"
#include "meltray/terms/pressure/weakly_compressible.hpp"

namespace meltray::terms {

struct AcousticFields;
struct AcousticArguments;

/// Everything that a weakly compressible scene sums over pairs at the pace of sound: pressure of the walls,
/// continuity, density diffusion, pressure force and artificial viscosity, in one pass over clusters (two
/// with Antuono's diffusion), with the geometry of the pairs at the positions of the moment. Terms are set up
/// in the public members; one with a coefficient of zero costs nothing.
class AcousticPass {
 public:
  EquationOfState state;
  DensityDiffusion diffusion;
  PressureForce force;
  ArtificialViscosity artificial;

  /// Which particles are pairs: those closer than the support and `skin` [m], in a box of these periods [m].
  /// Where the stage's own list has been built, its walls of the melt are the only ones that count; else all
  /// resting particles do, and this is what tells which particles are loose.
  void find_pairs(Stage& stage, double skin, const std::array<double, 3>& period);
  /// Takes positions, velocities and what `state` has made of the densities, for evaluate(), and gives the
  /// walls their pressures.
  void gather(Stage& stage);
  /// The sums over pairs; add_rates() hands them out.
  void evaluate(const Stage& stage);
  /// Adds the rate of the density [kg/m^3/s] and the acceleration by pressure and artificial viscosity.
  void add_rates(const Stage& stage, double* density_rate, const MutField& acceleration) const;

  /// Gives back the lists and fields of find_pairs().
  void release();
  /// Name of the instructions that the loops were compiled for.
  static const char* instructions();
  std::size_t bytes() const;

 private:
  /// A set of particles with its fields, one entry per slot.
  struct Fields {
    sph::ClusterSet set;
    std::array<AlignedDoubles, 3> x, v, gradient;
    AlignedDoubles density, volume, pressure, drag, excess;
    void pack(const Stage& stage);
    AcousticFields view();
    std::size_t bytes() const;
  };
  AcousticArguments arguments(const Stage& stage);

  std::array<double, 3> period_{};
  std::vector<std::uint8_t> kind_;
  Fields melt_, wall_;
  sph::ClusterList melt_melt_, melt_wall_, wall_melt_;
  AlignedDoubles density_rate_;
  std::array<AlignedDoubles, 3> force_;
  std::array<AlignedDoubles, 6> moment_;
};

}  // namespace meltray::terms
