// SPDX-License-Identifier: MIT
// Compiled for the oldest x86-64, and run before everything else in the program: on a processor without the
// instructions the rest was compiled for, a message instead of SIGILL.
#include <unistd.h>

namespace {

constexpr char kMessage[] =
    "meltray: this processor lacks instructions the program was compiled for (" MELTRAY_ISA_LEVEL
    "); build it again with -DMELTRAY_ISA=x86-64-v2 or none\n";

bool supported() {
  __builtin_cpu_init();
#if MELTRAY_ISA_NUMBER >= 4
  if (!__builtin_cpu_supports("avx512f") || !__builtin_cpu_supports("avx512bw") ||
      !__builtin_cpu_supports("avx512dq") || !__builtin_cpu_supports("avx512vl"))
    return false;
#endif
#if MELTRAY_ISA_NUMBER >= 3
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma") || !__builtin_cpu_supports("bmi2"))
    return false;
#endif
#if MELTRAY_ISA_NUMBER >= 2
  if (!__builtin_cpu_supports("sse4.2") || !__builtin_cpu_supports("popcnt")) return false;
#endif
  return true;
}

/// Priority 101: before the initialisation of any global object, which may use these instructions already.
__attribute__((constructor(101))) void check_instruction_set() {
  if (supported()) return;
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
  ::_exit(2);
}

}  // namespace
