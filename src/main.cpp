// SPDX-License-Identifier: MIT
#include <malloc.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "meltray/app/command_line.hpp"

namespace {

/// Threads that wait spin for some 40 us and then sleep: libgomp's default of milliseconds starves a shared
/// machine (measured: two threads fifteen times slower than one beside other programs). It reads its settings
/// before main(), so the program starts itself once more with them; a setting of the user's stands.
void start_with_short_spinning(char** argv) {
  if (std::getenv("GOMP_SPINCOUNT") != nullptr || std::getenv("OMP_WAIT_POLICY") != nullptr) return;
  // By its own path, so that the process keeps its name. Where that is not possible it runs all the same.
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error && setenv("GOMP_SPINCOUNT", "20000", 1) == 0) execv(program.c_str(), argv);
}

/// Arrays of a step are megabytes: got from and given back to the system each time, every page of them is
/// cleared anew (measured: 870 pages a step of a weld).
void keep_memory() {
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
}

}  // namespace

int main(int argc, char** argv) {
  start_with_short_spinning(argv);
  keep_memory();
  return meltray::app::run_command_line(argc, argv);
}
