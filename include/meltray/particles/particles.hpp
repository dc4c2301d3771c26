// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "meltray/core/archive.hpp"
#include "meltray/core/vec.hpp"

namespace meltray {

enum class Phase : std::uint8_t { solid = 0, liquid = 1 };

/// Bits of Particles::flags.
enum Flag : std::uint8_t {
  kClamped = 1,       ///< elastic solid that is held at its place and takes stress
  kResolidified = 2,  ///< was liquid and is solid again: the seam
  kRemoved = 4,       ///< left the scene (ejected or runaway): takes part in nothing
  kWasLiquid = 8,     ///< has been liquid at some time
  kMobile = 16,       ///< solid of an elastic scene that moves at present
};

/// All particles of a scene as separate arrays. The order never changes, so an index is a particle's
/// identity.
struct Particles {
  int dim = 3;
  Components x;                     ///< position [m]
  Components v;                     ///< velocity [m/s]
  std::vector<double> h;            ///< specific enthalpy [J/kg]
  std::vector<double> density;      ///< [kg/m^3]; weakly compressible scenes only, else empty
  SymmetricComponents stress;       ///< deviatoric stress S [Pa]; scenes with elastic solid only, else empty
  std::vector<double> mass;         ///< [kg] (per metre of depth in 2-D)
  std::vector<double> smoothing;    ///< smoothing length [m]; support radius is twice this
  std::vector<double> pressure;     ///< last pressure [Pa]; warm start of the Poisson solver
  std::vector<double> temperature;  ///< derived from h [K]; kept for output and for bulk conduction
  std::vector<std::uint8_t> phase;  ///< Phase
  std::vector<std::uint8_t> flags;  ///< Flag bits
  std::vector<std::uint8_t> wall;   ///< 0, or 1 + index of the box face a dummy belongs to

  std::size_t size() const { return h.size(); }
  bool is_liquid(std::size_t i) const { return phase[i] == static_cast<std::uint8_t>(Phase::liquid); }
  bool has(std::size_t i, Flag f) const { return (flags[i] & f) != 0; }
  /// Appends one solid particle at rest; `wall_face` is 1 + face for a dummy, 0 otherwise.
  void add(const Vec3& position, double enthalpy, double m, double smoothing_length,
           std::uint8_t wall_face = 0);
  /// Takes memory for so many particles, in the arrays that add() fills.
  void reserve(std::size_t n);
  /// Dummy particle outside a box face: fills kernels, never moves or melts.
  bool is_wall(std::size_t i) const { return wall[i] != 0; }
  std::size_t bytes() const;
  /// Saves or loads every array.
  void archive(Archive& a);
};

}  // namespace meltray
