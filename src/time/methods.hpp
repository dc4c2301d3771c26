// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
// The next header uses FILE without including it.
#include <arkode/arkode_butcher.h>

#include <memory>

#include "meltray/time/integrator.hpp"

namespace meltray::integration {

struct FreeTable {
  void operator()(ARKodeButcherTable t) const { ARKodeButcherTable_Free(t); }
};
using Table = std::unique_ptr<ARKodeButcherTableMem, FreeTable>;

/// Runge-Kutta coefficients of one method; a half that the method does not use is null.
struct Tableau {
  Table explicit_half, implicit_half;
  int order = 0;            ///< of the solution
  int embedding_order = 0;  ///< of the solution it is compared with for the error estimate

  /// The error estimate is proportional to dt to this power.
  int error_exponent() const { return (order < embedding_order ? order : embedding_order) + 1; }
};

/// Coefficients of method and order; of a multirate method those of its fast part. Throws UsageError for an
/// order that does not exist.
Tableau tableau(Method method, int order);

/// True when nothing uses the rate of stage `stage` (with_embedding: not even the error estimate).
bool stage_unused(const ARKodeButcherTableMem& table, int stage, bool with_embedding);

}  // namespace meltray::integration
