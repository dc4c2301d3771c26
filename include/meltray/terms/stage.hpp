// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "meltray/materials/material.hpp"
#include "meltray/particles/patch.hpp"
#include "meltray/sph/lattice.hpp"
#include "meltray/sph/pairs.hpp"

namespace meltray::terms {

/// A box face as the terms see it: dummies behind it carry its velocity and temperature.
struct WallFace {
  int axis = 0;      ///< component of the normal
  double plane = 0;  ///< coordinate of the face [m]
  bool no_slip = true;
  Vec3 velocity = Vec3::Zero();  ///< [m/s]
  bool isothermal = false;
  double temperature = 0;  ///< [K]
  double flux = 0;         ///< into the material [W/m^2]
};

/// Constants of a scene that every term may read.
struct SceneConstants {
  int dim = 3;
  double spacing = 0, smoothing = 0;  ///< of the lattice; h [m]
  double density = 0;                 ///< of the melt, rho_0 [kg/m^3]
  sph::KernelType kernel = sph::KernelType::wendland_c2;
  sph::LatticeSums lattice;
  Material material;
  std::array<WallFace, 6> faces;
  bool free_surface = true;     ///< false: the fluid fills its box and every particle is inside
  bool any_no_slip = false;     ///< some face is a no-slip wall
  bool any_isothermal = false;  ///< some face holds a temperature
  double melting_temperature() const { return material.liquidus; }
};

/// Everything about the patch at one evaluation of the right-hand side: positions, velocities and enthalpies
/// stand in the patch itself, the geometry of pairs in the list, and what is derived from them here.
struct Stage {
  const SceneConstants* constants = nullptr;
  Patch* patch = nullptr;
  sph::PairList* pairs = nullptr;
  double t = 0;

  std::vector<double> volume;       ///< m / rho [m^3]
  std::vector<double> temperature;  ///< [K]
  std::vector<std::uint8_t> heat;   ///< 1: integrates its enthalpy in this step
  std::vector<std::uint8_t> lit;    ///< 1: receives laser power
  std::vector<Index> moving;        ///< patch indices of liquid particles, ascending
  std::vector<Index> heated;        ///< patch indices with heat = 1, ascending
  std::vector<Index> elastic;       ///< patch indices of elastic solid, ascending; empty without

  std::vector<double> excess;  ///< rho - rho_0(T) of a weakly compressible scene [kg/m^3]; else empty

  // Free surface (filled by compute_surface when a term needs it; zero elsewhere, empty in scenes whose steps
  // have no surface).
  std::vector<double> fill;      ///< Shepard sum over that of a full lattice
  std::vector<double> diagonal;  ///< Laplacian sum over that of a full lattice
  std::vector<double> exposure;  ///< |grad c| over that of a flat face, at most 1
  std::vector<double> surface;   ///< 1 on the free surface, 0 inside, continuous in between
  Components grad_c;             ///< gradient of the colour function, into the material [1/m]
  Components normal;             ///< unit normal out of the material (zero where surface = 0)
  Components wall_normal;        ///< normal that a wall prescribes times its share; empty without wetting
  std::vector<double> area;      ///< free-surface area carried by a particle [m^2; m in 2-D]
  std::vector<double> face_temperature;  ///< [K]; empty where the particles' own temperature stands for it
  std::vector<double> surface_pressure;  ///< recoil + sigma kappa, averaged over surface neighbours [Pa]
  std::vector<std::uint8_t> loose;  ///< liquid with too few neighbours to be a fluid: flies ballistically

  Index size() const { return patch->size(); }
  /// Of the face that a particle carries, where it is known, else of the particle [K].
  double surface_temperature(Index i) const {
    return face_temperature.empty() ? temperature[i] : face_temperature[i];
  }
  double area_of_spacing() const;
  std::size_t bytes() const;
};

/// Fewest neighbours of a particle that takes part in the pressure field.
constexpr Index fewest_neighbours(int dim) {
  return dim == 2 ? 6 : 14;
}

/// Sizes the arrays for a newly selected patch and fills volume, moving and the index lists.
/// `heat` must be set before by the caller for all particles of the patch. Without `with_surface` the arrays
/// of the surface stay empty.
void prepare_stage(Stage& stage, bool with_surface = true);

/// Gives back the memory of the fields; which particles move and exchange heat stays.
void release_fields(Stage& stage);

/// Finds the free surface: Shepard sum, colour gradient, continuous surface weight, normals and areas, for
/// every row of the list. A particle of a flat face has a Shepard sum near 0.79 (h = 1.3 dx), one layer below
/// it 0.997, so a weight that falls from 1 at 0.86 to 0 at 0.94 tells them apart without a jump in time.
/// Recoil can press the outermost layer together until its Shepard sum is full; the colour gradient (exposure
/// 1 on a flat face, 0.06 below it, under 0.2 in disordered bulk) still shows it, so either of the two makes
/// a surface.
void compute_surface(Stage& stage);

/// The surface weights alone, of the particles that compute_surface() has rows for, from a list that is made
/// piece by piece and held by nobody: weight[i] for every particle of the patch. For output of scenes whose
/// steps need no surface.
void find_surface_weights(const Stage& stage, const CellGrid& grid, std::vector<double>& weight);

}  // namespace meltray::terms
