// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "meltray/core/archive.hpp"
#include "meltray/observe/files.hpp"
#include "meltray/scene/simulation.hpp"

namespace meltray::observe {

inline constexpr int kHistorySchema = 3;

/// Steps since the last row of history.csv; part of a checkpoint, so that a resumed run writes the same next
/// row.
struct StepsSinceRow {
  std::int64_t steps = 0;
  double seconds = 0;                           ///< simulated
  std::map<std::string, std::int64_t> limiter;  ///< steps by what set their length

  void add(const scene::StepInfo& step);
  double mean_step() const { return steps > 0 ? seconds / static_cast<double>(steps) : 0; }
  /// What set most of the steps (first by name among equals); "start" before any step.
  std::string main_limiter() const;
  void archive(Archive& a);
};

/// One row of history.csv. SI units, as the column names say.
struct HistoryRow {
  double time = 0;
  double laser_power = 0, absorbed = 0, escaped = 0, residual = 0;
  double capillary_depth = 0, axis_depth = 0;
  bool closed = false;
  double pool_length = 0, pool_width = 0, pool_depth = 0, top_surface = 0;
  double max_temperature = 0, max_speed = 0;
  std::size_t liquid = 0, active = 0;
  double ejected_mass = 0, evaporative_loss = 0;
  double density_variation = 0;  ///< of a weakly compressible melt, relative
  double dt = 0;                 ///< mean since the row before [s]
  std::string limiter;           ///< what set most steps since the row before
  std::int64_t steps = 0;        ///< since t = 0
  scene::EnergyBudget energy;
  double energy_error = 0;  ///< relative
};

/// Looks at the simulation in its present state; changes nothing in it.
HistoryRow measure(const scene::Simulation& simulation, const StepsSinceRow& since);

/// Names of the columns, in order, separated by commas.
std::string history_header();
/// Numbers in the shortest form that reads back to the same bits.
std::string history_line(const HistoryRow& row);

/// Cuts off rows later than `time` [s] and lines at the end that are not complete. Throws UsageError when the
/// header is not that of this program or a line before the last row that stays is damaged, IoError when the
/// file cannot be read or replaced.
void cut_history(const std::filesystem::path& file, double time);

/// Columns of a history.csv by name. Throws UsageError with file and line.
std::map<std::string, std::vector<double>> read_history(const std::filesystem::path& file);

}  // namespace meltray::observe
