// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "meltray/scene/simulation.hpp"

namespace meltray::observe {

inline constexpr int kSummarySchema = 2;

/// What the simulation itself does not know about a run.
struct RunRecord {
  std::string case_name;
  std::string outcome;  ///< running, finished, stopped, interrupted, terminated, failed, io_error, error
  std::string message;  ///< of a failure
  int exit_code = 0;
  double target_time = 0;       ///< [s] to which this run goes
  double wall_seconds = 0;      ///< of all sessions that led here
  double session_start = 0;     ///< simulated time at which this process began [s]
  double session_wall = 0;      ///< wall seconds of this process
  int resumed = 0;              ///< number of resumptions
  std::int64_t active = 0;      ///< particles that took part in the last step, of whatever session
  std::string forked_from;      ///< folder and time, empty for an ordinary run
  double checkpoint_time = -1;  ///< [s]; negative: none
  int threads = 1;
  std::vector<std::string> warnings;  ///< of the last session
  double mean_density_variation = 0;  ///< over the rows of history.csv
  /// Bytes by part when a row of history.csv was last written.
  std::vector<std::pair<std::string, std::size_t>> memory;
};

/// summary.json as text. `simulation` may be null when it could not be built.
std::string summary_text(const RunRecord& record, scene::Simulation* simulation);
/// Replaces summary.json in one step.
void write_summary(const std::filesystem::path& file, const RunRecord& record, scene::Simulation* simulation);

/// Largest resident set of this process so far [bytes].
double peak_memory();

}  // namespace meltray::observe
