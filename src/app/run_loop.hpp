// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "app/log.hpp"
#include "meltray/observe/checkpoint.hpp"
#include "meltray/observe/history.hpp"
#include "meltray/observe/progress.hpp"
#include "meltray/observe/run_folder.hpp"
#include "meltray/observe/snapshots.hpp"
#include "meltray/observe/summary.hpp"
#include "meltray/scene/simulation.hpp"

namespace meltray::app {

/// What decides the future of a run besides the simulation; stored in its checkpoints.
struct RunState {
  observe::StepsSinceRow since_row;
  double wall_seconds = 0;  ///< up to this point, over all sessions
  std::int64_t resumed = 0;
  std::int64_t active = 0;  ///< particles that took part in the last step
  std::string forked_from;
  std::string case_fingerprint;  ///< of everything in case.toml but the end time

  void archive(Archive& a);
};

/// Fingerprint of a scene without its end time, which a resumed run may move.
std::string fingerprint(scene::Scene scene);
/// case.toml: every key with its value.
void write_case_file(const observe::RunFolder& folder, const scene::Scene& scene);

/// summary.json of a run whose simulation could not even be built.
void record_failed_start(const observe::RunFolder& folder, const std::string& case_name,
                         const std::exception& e);

/// Advances a simulation to `end`, watched: rows of history.csv, snapshots and checkpoints at exact multiples
/// of their intervals, progress, signals, and a summary.json whatever happens.
class RunLoop {
 public:
  struct Options {
    std::string case_name;
    double end = 0;  ///< [s]
    bool quiet = false;
  };

  /// history.csv and the snapshots of the folder end at the simulation's time afterwards (a run that starts
  /// at t = 0 has none yet).
  RunLoop(scene::Simulation& simulation, observe::RunFolder& folder, observe::CheckpointSlots& slots,
          RunState state, Options options);

  /// Runs to the end or until a signal. Returns the exit code; throws what stopped the run, after writing
  /// what can be saved.
  int run();
  /// Saves the present state as the starting point of a fork.
  void write_first_checkpoint() { write_checkpoint(true); }

 private:
  void start();
  void advance();
  int finish();
  int stop_by_signal(int signal);
  void record_failure(const std::string& message);
  void record_io_error(const std::string& message);

  void write_row();
  void write_snapshot();
  void write_seam() const;
  void write_checkpoint(bool scheduled);
  void write_summary(const std::string& outcome, int exit_code, const std::string& message = "");
  void say(const std::string& text);
  void warn(const std::string& text);
  void warn_of_ends(const observe::HistoryRow& row);
  bool reached(double t) const;
  double session_wall() const;

  scene::Simulation& simulation_;
  observe::RunFolder& folder_;
  observe::CheckpointSlots& slots_;
  RunState state_;
  Options options_;
  Log log_;
  observe::LineFile history_;
  observe::Snapshots snapshots_;
  observe::Progress progress_;
  std::chrono::steady_clock::time_point began_;
  double start_time_, wall_before_;
  double row_time_ = -1;    ///< of the last row
  double density_sum_ = 0;  ///< of the density variation over the rows of history.csv
  std::int64_t rows_ = 0;
  double checkpoint_time_ = -1;  ///< of the newest checkpoint
  double scheduled_time_ = 0;    ///< of the last scheduled one, or where this session began
  bool warned_of_density_ = false, warned_of_ends_ = false;
  std::vector<std::string> warnings_;  ///< of this session
  /// Bytes by part when the last row was written.
  std::vector<std::pair<std::string, std::size_t>> memory_;
};

}  // namespace meltray::app
