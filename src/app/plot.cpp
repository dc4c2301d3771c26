// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "app/script.hpp"
#include "meltray/app/commands.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/observe/run_folder.hpp"

namespace meltray::app {
namespace fs = std::filesystem;

int plot(const std::vector<fs::path>& run_folders) {
  std::vector<std::string> arguments;
  for (const auto& folder : run_folders) {
    if (!observe::is_run_folder(folder))
      throw UsageError(fmt::format("{}: not a run folder of meltray", folder.string()));
    arguments.push_back(folder.string());
  }
  return run_script("plot_run.py", arguments);
}

}  // namespace meltray::app
