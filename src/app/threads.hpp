// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>
#include <omp.h>

#include "meltray/core/errors.hpp"
#include "meltray/core/parallel.hpp"

namespace meltray::app {

/// 0: all cores (or what OMP_NUM_THREADS says).
inline void use_threads(int n) {
  if (n < 0) throw UsageError(fmt::format("--threads {}: a number above 0 is needed", n));
  if (n > 0) set_threads(n);
}

}  // namespace meltray::app
