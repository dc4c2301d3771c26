// SPDX-License-Identifier: MIT
#pragma once

#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_nonlinearsolver.h>

#include <exception>
#include <memory>
#include <string>

#include "time/methods.hpp"
#include "time/one_step.hpp"
#include "time/state_vector.hpp"

namespace meltray::integration {

/// Runge-Kutta steps by ARKODE's ARKStep, one attempt at a time. Each attempt restarts ARKODE from (t, y), so
/// that nothing of earlier steps enters, and the choice of the next step stays with the caller.
class ArkodeDriver : public OneStep {
 public:
  /// Everything passed by reference must outlive the driver. `tableau` has an implicit half; explicit methods
  /// are left to ExplicitDriver.
  ArkodeDriver(SUNContext context, VectorSpace& space, const Tableau& tableau, const Parts& parts,
               bool estimate_error, IntegratorCounters& counters);
  ~ArkodeDriver() override;
  ArkodeDriver(const ArkodeDriver&) = delete;
  ArkodeDriver& operator=(const ArkodeDriver&) = delete;

  void begin(OdeProblem& problem, double t, N_Vector y) override;
  Attempt advance(double h, N_Vector y_new) override;

 private:
  struct Callbacks;
  friend struct Callbacks;
  struct FreeMemory {
    void operator()(void* mem) const;
  };
  struct FreeSolver {
    void operator()(SUNLinearSolver s) const { SUNLinSolFreeEmpty(s); }
  };
  struct FreeStageSolver {
    void operator()(SUNNonlinearSolver s) const { SUNNonlinSolFreeEmpty(s); }
  };
  /// Rate at (t, y) of a step, kept because ARKODE asks for it twice and again in every further attempt.
  struct StartRate {
    OwnedVector value;
    bool known = false;
  };
  void create(SUNContext context);
  void create_newton(SUNContext context);
  void create_stage_solver(SUNContext context);
  void check(int code, const char* call) const;
  Attempt judge(int code, N_Vector y_new);

  VectorSpace& space_;
  const Tableau& tableau_;
  const Parts parts_;
  const bool explicit_rates_, implicit_rates_;  // what ARKODE is given
  const bool estimate_error_;
  IntegratorCounters& counters_;
  OwnedVector scratch_, known_;
  StartRate explicit_start_, implicit_start_;
  std::unique_ptr<_generic_SUNLinearSolver, FreeSolver> solver_;                // of Newton's method
  std::unique_ptr<_generic_SUNNonlinearSolver, FreeStageSolver> stage_solver_;  // of linear problems
  std::unique_ptr<void, FreeMemory> mem_;
  std::string message_;  // ARKODE's last complaint

  // The step under way.
  OdeProblem* problem_ = nullptr;
  double t_ = 0, h_ = 0;
  N_Vector y_ = nullptr;
  bool rate_not_finite_ = false, solver_failed_ = false;
  std::exception_ptr thrown_;
};

}  // namespace meltray::integration
