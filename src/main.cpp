// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <cstdlib>

#include "meltray/app/command_line.hpp"

namespace {

/// Threads that wait spin for some 40 us and then sleep: libgomp's default of milliseconds starves a shared
/// machine (measured: two threads fifteen times slower than one beside other programs). It reads its settings
/// before main(), so the program starts itself once more with them; a setting of the user's stands.
void start_with_short_spinning(char** argv) {
  if (std::getenv("GOMP_SPINCOUNT") != nullptr || std::getenv("OMP_WAIT_POLICY") != nullptr) return;
  if (setenv("GOMP_SPINCOUNT", "20000", 1) == 0) execv("/proc/self/exe", argv);
  // Where that is not possible the program runs all the same.
}

}  // namespace

int main(int argc, char** argv) {
  start_with_short_spinning(argv);
  return meltray::app::run_command_line(argc, argv);
}
