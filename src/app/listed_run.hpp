// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace meltray::app {

/// One run of a list that may be worked off here, one after the other and with interruptions, or elsewhere by
/// its command.
struct ListedRun {
  std::filesystem::path case_file, folder;
  std::vector<std::string> set;
  double until = 0;  ///< [s]
};

/// The command line that does the run, or goes on with it where its folder is there, quoted for a shell.
std::string command_of(const ListedRun& run);

/// Spacing of the particles of a run folder [m], as its own case file has it; 0 where it has none.
/// Throws UsageError where that file cannot be read.
double spacing_of(const std::filesystem::path& folder);

/// Whether a run stands at its end, by its observe::recorded_summary().
bool reached(const ListedRun& run, const nlohmann::json& summary);

/// Runs or continues it and returns an exit code. A numerical failure is printed, stays in the run's folder
/// and counts as done.
int carry_out(const ListedRun& run, int threads);

}  // namespace meltray::app
