// SPDX-License-Identifier: MIT
#pragma once

#include "time/one_step.hpp"
#include "time/state_vector.hpp"

namespace meltray::integration {

/// Forward Euler for the explicit part, then backward Euler for the implicit part: the classical first-order
/// splitting, y* = y + h f_E(t, y), y1 = y* + h f_I(t + h, y1). No error estimate.
class ForwardBackwardEuler : public OneStep {
 public:
  ForwardBackwardEuler(VectorSpace& space, const Parts& parts, IntegratorCounters& counters);
  void begin(OdeProblem& problem, double t, N_Vector y) override;
  Attempt advance(double h, N_Vector y_new) override;

 private:
  Outcome solve(double h, N_Vector y_new);

  VectorSpace& space_;
  const Parts parts_;
  IntegratorCounters& counters_;
  OwnedVector rate_, predicted_, correction_;
  OdeProblem* problem_ = nullptr;
  double t_ = 0;
  N_Vector y_ = nullptr;
  bool rate_known_ = false;
};

}  // namespace meltray::integration
