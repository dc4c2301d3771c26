// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace meltray::observe {

/// The folder of one run: marker, lock, and the places of its files. A folder is ours when it carries the
/// marker
/// `.meltray-run`; only such folders are ever emptied, and of them only the files a run writes.
class RunFolder {
 public:
  struct Options {
    std::optional<std::filesystem::path> out;  ///< explicit folder
    bool overwrite = false;
    std::string case_name;                ///< default folder: runs/<case_name>, then -002, ...
    std::filesystem::path runs = "runs";  ///< where default folders are made
    bool fork = false;                    ///< of another run: nothing there may be replaced
  };

  /// Makes and locks the folder of a new run. UsageError: see the contract of --out and --overwrite; also
  /// when another process holds the lock. IoError when it cannot be made.
  static RunFolder create(const Options& options);
  /// Opens and locks an existing run folder. UsageError when there is none, it is not ours, or it is in use.
  static RunFolder open(const std::filesystem::path& path);

  ~RunFolder();
  RunFolder(RunFolder&& other) noexcept;
  RunFolder& operator=(RunFolder&&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path file(std::string_view name) const { return path_ / name; }
  /// Random name of the run, written into its checkpoints.
  const std::string& run_id() const { return run_id_; }

  /// Sets aside space so that summary.json can still be written when the disk is full; frees it.
  void reserve_space() const;
  void release_space() const;

 private:
  RunFolder(std::filesystem::path path, int lock, std::string run_id);
  std::filesystem::path path_;
  int lock_ = -1;
  std::string run_id_;
};

/// True for folders that carry the marker.
bool is_run_folder(const std::filesystem::path& path);
/// summary.json of a run folder; an empty object when there is none or it cannot be read.
nlohmann::json recorded_summary(const std::filesystem::path& run_folder);
/// "outcome" of summary.json; empty when there is none or it cannot be read.
std::string recorded_outcome(const std::filesystem::path& run_folder);
/// "time_s" of summary.json [s]; 0 when there is none.
double recorded_time(const std::filesystem::path& run_folder);
/// "case" of summary.json, or the name of the folder.
std::string recorded_case(const std::filesystem::path& run_folder);
/// True for outcomes after which there is nothing left to do.
bool is_finished(const std::string& outcome);

}  // namespace meltray::observe
