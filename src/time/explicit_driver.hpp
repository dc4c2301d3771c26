// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "time/methods.hpp"
#include "time/one_step.hpp"
#include "time/state_vector.hpp"

namespace meltray::integration {

/// Explicit Runge-Kutta steps with ARKODE's tables and, to the bit, its sums. ARKODE holds twelve vectors for
/// two stages; here it is the rates of the stages, and the new state in which the stages are evaluated: in
/// large scenes the vectors are what takes most memory.
class ExplicitDriver : public OneStep {
 public:
  /// Everything passed by reference must outlive the driver. Implicit rates of the problem are added to the
  /// explicit ones.
  ExplicitDriver(VectorSpace& space, const Tableau& tableau, const Parts& parts, bool estimate_error,
                 IntegratorCounters& counters);

  void begin(OdeProblem& problem, double t, N_Vector y) override;
  Attempt advance(double h, N_Vector y_new) override;

 private:
  bool rate(double t, N_Vector y, N_Vector f);
  void add_row(double h, const double* a, int stages, N_Vector y_new);
  double error(double h);

  VectorSpace& space_;
  const ARKodeButcherTableMem& table_;
  const Parts parts_;
  const bool estimate_error_;
  IntegratorCounters& counters_;
  std::vector<OwnedVector> rates_;
  OwnedVector implicit_rate_;
  std::vector<double> coefficient_;
  std::vector<N_Vector> term_;

  // The step under way.
  OdeProblem* problem_ = nullptr;
  double t_ = 0;
  N_Vector y_ = nullptr;
  bool start_known_ = false;  ///< the first rate is that of (t, y)
};

}  // namespace meltray::integration
