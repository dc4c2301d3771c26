// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "meltray/core/aligned.hpp"
#include "meltray/core/vec.hpp"
#include "meltray/particles/patch.hpp"

/// Pairs of clusters (Pall & Hess 2013) for passes that compute the geometry of a pair anew: particles stand
/// in octets, neighbours in space, and a row of pairs is a list of octets. Neighbours are then read side by
/// side, without gathers; the price is that only a third of the pairs computed lie within the support.
/// For particles of one smoothing length. The other lists of a scene are in pairs.hpp.
namespace meltray::sph {

/// Particles in an octet, and rows that share one list of octets.
inline constexpr Index kLanes = 8, kGroupRows = 2;
/// Coordinate of empty slots: beyond the reach of everything [m].
inline constexpr double kNowhere = 1e30;

/// Some particles of a patch in octets: columns two or three spacings wide, each sorted by height and cut
/// into pieces of eight. The last octet of a column may have empty slots.
class ClusterSet {
 public:
  /// Takes the particles with chosen[i] = `kind`. `period` [m] per direction, 0 where there is none.
  void sort(const Patch& patch, const std::vector<std::uint8_t>& chosen, std::uint8_t kind, double spacing,
            const std::array<double, 3>& period);

  Index slots() const { return static_cast<Index>(particle_.size()); }
  Index octets() const { return slots() / kLanes; }
  Index groups() const { return slots() / kGroupRows; }
  /// Patch index of the particle in a slot; -1 in empty slots.
  const std::vector<Index>& particle() const { return particle_; }
  /// Copies a field of the patch into slots, `empty` where no particle is.
  void pack(const std::vector<double>& field, double empty, AlignedDoubles& out) const;
  /// Gives back what only the building of lists needs: positions and boxes.
  void close();
  std::size_t bytes() const;

 private:
  friend class ClusterList;
  struct Box {
    std::array<double, 3> min, max;
  };
  Index column_of(const std::array<double, 3>& x) const;

  int dim_ = 3;
  std::array<double, 3> period_{};
  std::array<double, 2> origin_{}, inverse_width_{};  ///< of the columns, horizontally
  std::array<Index, 2> columns_{1, 1};
  std::vector<Index> particle_;
  std::vector<Index> column_start_;         ///< first octet of each column
  std::vector<Box> box_;                    ///< of each octet
  std::array<AlignedDoubles, 3> position_;  ///< of each slot, wrapped into the period
  Box all_{};                               ///< of the whole set
};

/// For each group of rows the octets of which some particle is within reach of some row.
class ClusterList {
 public:
  /// Pairs closer than `reach` [m] are all in the list.
  void build(const ClusterSet& rows, const ClusterSet& sources, double reach);
  /// Particles within reach of each slot of the rows when the list was built, itself included.
  const std::vector<Index>& neighbours() const { return neighbours_; }
  const Index* start() const { return start_.data(); }
  const Index* octets() const { return octet_.data(); }
  std::size_t bytes() const {
    return (start_.capacity() + octet_.capacity() + neighbours_.capacity()) * sizeof(Index);
  }

 private:
  /// Consecutive octets of rows, handled by one task, and the lists of their groups, one after the other.
  struct Block {
    std::vector<Index> count, octet, candidate, of_group;
  };
  template <int D>
  void search(const ClusterSet& rows, const ClusterSet& sources, Index octet, double reach, Block& block);

  std::vector<Index> start_{0}, octet_, neighbours_;
};

}  // namespace meltray::sph
