// SPDX-License-Identifier: MIT
#include "app/script.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "app/repository.hpp"
#include "meltray/app/commands.hpp"
#include "meltray/core/errors.hpp"

namespace meltray::app {
namespace fs = std::filesystem;
namespace {

/// Another python3 may stand first on PATH without h5py and matplotlib.
constexpr const char* kPython = "/usr/bin/python3";

}  // namespace

int run_script(const char* name, const std::vector<std::string>& arguments) {
  const fs::path script = repository_folder("scripts", "MELTRAY_SCRIPTS") / name;
  if (!fs::exists(script))
    throw UsageError(
        fmt::format("{}: not found; MELTRAY_SCRIPTS names the folder of the scripts", script.string()));
  std::vector<std::string> words{kPython, script.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
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
