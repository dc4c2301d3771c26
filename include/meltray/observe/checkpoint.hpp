// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "meltray/core/archive.hpp"

namespace meltray::observe {

inline constexpr int kCheckpointSchema = 3;

/// What a checkpoint says about itself.
struct CheckpointHeader {
  std::string run_id;   ///< of the run folder it belongs to
  std::string version;  ///< of the program that wrote it
  double time = 0;      ///< [s]
  std::int64_t step = 0;
  /// Written at a time the case file fixes. The uninterrupted run drops its history at the same time, so only
  /// from such a checkpoint does a resumed run repeat it bit for bit.
  bool scheduled = true;
  std::size_t expected_bytes = 0;  ///< of the state, where known; not written
};

/// An opened checkpoint: verified against its checksum as a whole before any of it is read.
struct Checkpoint {
  std::filesystem::path file;
  CheckpointHeader header;
  std::unique_ptr<Archive> archive;  ///< loading() is true
};

/// Writes one checkpoint: a 512-byte text block (schema, size, FNV-1a checksum over everything behind it)
/// followed by an HDF5 file, uncompressed doubles; HDF5 programs skip the block. Throws IoError.
void write_checkpoint(const std::filesystem::path& file, const CheckpointHeader& header,
                      const std::function<void(Archive&)>& save);

/// Throws UsageError, naming the file and what is wrong: not a checkpoint, other schema, truncated, checksum,
/// or written by another run than `run_id` (an empty run_id accepts any). IoError when it cannot be read.
Checkpoint open_checkpoint(const std::filesystem::path& file, const std::string& run_id);

/// The two files of a run folder, written in turn.
class CheckpointSlots {
 public:
  CheckpointSlots(std::filesystem::path folder, std::string run_id);

  /// Replaces the file that is not the newest scheduled checkpoint.
  void write(CheckpointHeader header, const std::function<void(Archive&)>& save);

  /// Newest valid checkpoint; with `prefer_scheduled`, an unscheduled one only if there is no scheduled one.
  /// Nothing when neither file exists. UsageError with the complaint about each file when none is valid.
  /// Complaints about damaged files that were passed over are appended to `warnings`.
  std::optional<Checkpoint> newest(bool prefer_scheduled, std::vector<std::string>& warnings);

  std::filesystem::path file(int slot) const;

 private:
  std::filesystem::path folder_;
  std::string run_id_;
  int next_ = 0;
};

}  // namespace meltray::observe
