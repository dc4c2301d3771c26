// SPDX-License-Identifier: MIT
#include "app/repository.hpp"

#include <cstdlib>

namespace meltray::app {
namespace fs = std::filesystem;

fs::path repository_folder(const char* name, const char* variable) {
  if (const char* folder = std::getenv(variable)) return folder;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path beside = program.parent_path().parent_path().parent_path() / name;
  if (!error && fs::is_directory(beside, error)) return beside;
  return fs::path(MELTRAY_SOURCE_DIR) / name;
}

}  // namespace meltray::app
