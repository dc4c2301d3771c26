// SPDX-License-Identifier: MIT
#pragma once

/// True where this processor has the instructions of x86-64-v<level>, as far as compilers use them. Static on
/// purpose: each object keeps a copy compiled for its own instructions, which the linker must not exchange.
static inline bool processor_has_level(int level) {
  __builtin_cpu_init();
  if (level >= 4 && !(__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")))
    return false;
  if (level >= 3 &&
      !(__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2")))
    return false;
  return level < 2 || (__builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt"));
}
