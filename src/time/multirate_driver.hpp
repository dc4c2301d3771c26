// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
// The next header uses FILE without including it.
#include <arkode/arkode_mristep.h>
#include <sundials/sundials_context.h>

#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "time/methods.hpp"
#include "time/one_step.hpp"
#include "time/state_vector.hpp"

namespace meltray::integration {

/// Multirate infinitesimal GARK steps (Sandu 2019) by ARKODE's MRIStep: f_I is the slow part, evaluated
/// explicitly once a slow stage; f_E the fast one, advanced between the slow stages by explicit Runge-Kutta
/// steps of our own that add ARKODE's forcing. The slow step is fixed: ARKODE 6.4.1 has no error control for
/// it.
class MultirateDriver : public OneStep {
 public:
  /// Everything passed by reference must outlive the driver. `fast` is explicit; its order, 3 or 4, is that
  /// of the slow method too. `fast_step` bounds the fast step [s]; 0: the problem's stability limit at the
  /// start of each slow step. A bound below `min_step` [s] is a NumericalFailure.
  MultirateDriver(SUNContext context, VectorSpace& space, const Tableau& fast, const Parts& parts,
                  double fast_step, double min_step, IntegratorCounters& counters);
  ~MultirateDriver() override;
  MultirateDriver(const MultirateDriver&) = delete;
  MultirateDriver& operator=(const MultirateDriver&) = delete;

  void begin(OdeProblem& problem, double t, N_Vector y) override;
  Attempt advance(double h, N_Vector y_new) override;

 private:
  struct Callbacks;
  friend struct Callbacks;
  struct FreeMemory {
    void operator()(void* mem) const { MRIStepFree(&mem); }
  };
  struct FreeInner {
    void operator()(MRIStepInnerStepper s) const { MRIStepInnerStepper_Free(&s); }
  };
  void check(int code, const char* call) const;
  bool fast_rate(double t, N_Vector y, N_Vector f);
  bool slow_rate(double t, N_Vector y, N_Vector f);
  /// Bound of the fast step at the start of a slow one [s].
  double fast_limit(OdeProblem& problem, double t, N_Vector y) const;
  /// Advances y by fast steps of equal length with the forcing that stands for the slow part.
  bool advance_fast(double from, double to, N_Vector y);

  VectorSpace& space_;
  const Tableau& fast_;
  const Parts parts_;
  const double largest_fast_step_, min_step_;
  IntegratorCounters& counters_;
  std::vector<OwnedVector> rates_;  // of the fast stages
  OwnedVector stage_;
  std::unique_ptr<_MRIStepInnerStepper, FreeInner> inner_;
  std::unique_ptr<void, FreeMemory> mem_;
  std::string message_;  // ARKODE's last complaint

  // The step under way.
  OdeProblem* problem_ = nullptr;
  double t_ = 0, end_ = 0, fast_step_ = 0;
  N_Vector y_ = nullptr;
  bool not_finite_ = false;
  std::exception_ptr thrown_;
};

}  // namespace meltray::integration
