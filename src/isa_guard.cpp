// SPDX-License-Identifier: MIT
// Compiled for the oldest x86-64, and run before everything else in the program: on a processor without the
// instructions the rest was compiled for, a message instead of SIGILL.
#include <unistd.h>

#include "processor.hpp"

namespace {

constexpr char kMessage[] =
    "meltray: this processor lacks instructions the program was compiled for (" MELTRAY_ISA_LEVEL
    "); build it again with -DMELTRAY_ISA=x86-64-v2 or none\n";

/// Priority 101: before the initialisation of any global object, which may use these instructions already.
__attribute__((constructor(101))) void check_instruction_set() {
  if (processor_has_level(MELTRAY_ISA_NUMBER)) return;
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
  ::_exit(2);
}

}  // namespace
