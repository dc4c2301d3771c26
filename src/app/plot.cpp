// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "app/repository.hpp"
#include "meltray/app/commands.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/observe/run_folder.hpp"

namespace meltray::app {
namespace fs = std::filesystem;
namespace {

/// Another python3 may stand first on PATH without h5py and matplotlib.
constexpr const char* kPython = "/usr/bin/python3";

}  // namespace

int plot(const std::vector<fs::path>& run_folders) {
  for (const auto& folder : run_folders)
    if (!observe::is_run_folder(folder))
      throw UsageError(fmt::format("{}: not a run folder of meltray", folder.string()));
  const fs::path script = repository_folder("scripts", "MELTRAY_SCRIPTS") / "plot_run.py";
  if (!fs::exists(script))
    throw UsageError(
        fmt::format("{}: not found; MELTRAY_SCRIPTS names the folder of the scripts", script.string()));
  std::vector<std::string> words{kPython, script.string()};
  for (const auto& folder : run_folders) words.push_back(folder.string());
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  pid_t child = 0;
  if (const int error = posix_spawn(&child, kPython, nullptr, nullptr, argv.data(), environ))
    throw IoError(fmt::format("{}: {} (the pictures need python3-h5py and python3-matplotlib)", kPython,
                              std::strerror(error)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) return 128 + WTERMSIG(status);
  const int code = WEXITSTATUS(status);
  return code == kExitOk || code == kExitUsage ? code : kExitIo;
}

}  // namespace meltray::app
