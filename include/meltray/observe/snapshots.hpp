// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "meltray/laser/beam.hpp"
#include "meltray/particles/particles.hpp"

namespace meltray::observe {

inline constexpr int kSnapshotSchema = 1;

/// What goes into one snapshot besides the particles.
struct SnapshotInfo {
  double time = 0;     ///< [s]
  double spacing = 0;  ///< [m]
  std::string title;
  const laser::Beam* beam = nullptr;  ///< drawn into pictures; may be null
  const std::vector<std::uint8_t>* on_surface = nullptr;
};

/// Snapshots particles/000000.h5, ... (single precision, shuffle + gzip 1; positions and velocities always
/// with three components; the stress after von Mises where solid is elastic) and the collection
/// particles.xdmf over all of them, rewritten in one step after each.
class Snapshots {
 public:
  /// Takes over the snapshots in `run_folder` that are not later than `time` and removes later ones; a new
  /// run passes a negative time.
  Snapshots(std::filesystem::path run_folder, double time);

  /// Writes the next file: every particle that is neither wall nor removed. Throws IoError.
  void write(const Particles& particles, const SnapshotInfo& info);
  /// Time of the newest one [s]; negative when there is none.
  double last_time() const { return entries_.empty() ? -1 : entries_.back().time; }
  std::size_t count() const { return entries_.size(); }

 private:
  struct Entry {
    std::string file;  ///< relative to the run folder
    double time;
    std::size_t particles;
  };
  void write_collection() const;

  std::filesystem::path folder_;
  std::vector<Entry> entries_;
  bool has_stress_ = false;  ///< the scene has elastic solid
  int next_ = 0;             ///< number in the name of the next file
};

}  // namespace meltray::observe
