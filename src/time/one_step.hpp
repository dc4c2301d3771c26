// SPDX-License-Identifier: MIT
#pragma once

#include <sundials/sundials_nvector.h>

#include "meltray/time/integrator.hpp"

namespace meltray::integration {

/// How one attempted step ended.
enum class Outcome {
  done,          ///< the new state is there
  inaccurate,    ///< its error estimate exceeds 1
  not_finite,    ///< NaN or infinity in a rate or in the new state
  not_converged  ///< the implicit solve failed
};

struct Attempt {
  Outcome outcome = Outcome::done;
  double error = 0;  ///< weighted norm of the local error estimate, where one was asked for
};

/// Parts of a problem that a stepper is set up for; another combination needs another stepper.
struct Parts {
  bool has_explicit = true, has_implicit = true, implicit_is_linear = false;
  bool operator==(const Parts&) const = default;
};

/// A method that advances the state by one step from nothing but (t, y).
class OneStep {
 public:
  virtual ~OneStep() = default;
  /// Start of a step; y stays as it is until the next begin().
  virtual void begin(OdeProblem& problem, double t, N_Vector y) = 0;
  /// Tries length h and writes to y_new, which is undefined unless the outcome is `done`. May be called again
  /// with a smaller h: what belongs to (t, y) alone is evaluated once.
  virtual Attempt advance(double h, N_Vector y_new) = 0;
};

}  // namespace meltray::integration
