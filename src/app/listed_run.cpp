// SPDX-License-Identifier: MIT
#include "app/listed_run.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/schedule.hpp"
#include "app/toml_file.hpp"
#include "meltray/app/commands.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/core/shell.hpp"
#include "meltray/observe/run_folder.hpp"

namespace meltray::app {

std::string command_of(const ListedRun& r) {
  if (observe::is_run_folder(r.folder))
    return fmt::format("meltray resume {} --until {}", shell_word(r.folder.string()), r.until);
  std::string text = fmt::format("meltray run {} --out {} --until {}", shell_word(r.case_file.string()),
                                 shell_word(r.folder.string()), r.until);
  for (const auto& s : r.set) text += " --set " + shell_word(s);
  return text;
}

double spacing_of(const std::filesystem::path& folder) {
  return read_toml(folder / "case.toml")["domain"]["spacing_m"].value_or(0.0);
}

bool reached(const ListedRun& r, const nlohmann::json& summary) {
  return summary.value("time_s", 0.0) >= r.until * (1 - kSameTime);
}

int carry_out(const ListedRun& r, int threads) {
  try {
    if (observe::is_run_folder(r.folder)) {
      ResumeArguments again;
      again.run_folder = r.folder;
      again.until = r.until;
      again.threads = threads;
      again.quiet = true;
      return resume(again);
    }
    RunArguments first;
    first.case_file = r.case_file;
    first.out = r.folder;
    first.set = r.set;
    first.until = r.until;
    first.threads = threads;
    first.quiet = true;
    return run(first);
  } catch (const NumericalFailure& e) {
    fmt::print("{}: {}\n", r.folder.filename().string(), e.what());
    return kExitOk;
  }
}

}  // namespace meltray::app
