// SPDX-License-Identifier: MIT
#include "time/arkode_driver.hpp"

#include <arkode/arkode_arkstep.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "meltray/core/errors.hpp"

namespace meltray::integration {
namespace {

/// Newton's method stops below this fraction of the tolerance of a step.
constexpr double kNewtonFraction = 1e-3;
constexpr int kNewtonIterations = 10;

/// True when the only stages at time t (within rounding) are stages whose rates nothing uses.
bool unused_at(const ARKodeButcherTableMem& table, double start, double h, double t, bool with_embedding) {
  const double near = 1e-9 * h + 4 * std::numeric_limits<double>::epsilon() * std::abs(t);
  bool found = false;
  for (int s = 0; s < table.stages; ++s) {
    if (std::abs(start + table.c[s] * h - t) > near) continue;
    if (!stage_unused(table, s, with_embedding)) return false;
    found = true;
  }
  return found;
}

}  // namespace

/// What ARKODE calls. No exception may pass through its C frames: it is kept and thrown again afterwards.
struct ArkodeDriver::Callbacks {
  static ArkodeDriver& self(void* user) { return *static_cast<ArkodeDriver*>(user); }

  template <class F>
  static int guarded(ArkodeDriver& d, F&& f) {
    try {
      return f();
    } catch (...) {
      d.thrown_ = std::current_exception();
      return -1;
    }
  }

  /// Evaluates a rate unless it is known or not needed. Only stage 0 stands at the start of the step, in
  /// every table used here, so that the time alone identifies it.
  template <class Evaluate>
  static int rate(ArkodeDriver& d, const ARKodeButcherTableMem& table, StartRate& start, double t, N_Vector f,
                  Evaluate&& evaluate) {
    return guarded(d, [&] {
      if (unused_at(table, d.t_, d.h_, t, d.estimate_error_)) {
        N_VConst(0.0, f);
        return 0;
      }
      const bool at_start = t == d.t_;
      if (at_start && start.known) {
        N_VScale(1.0, start.value.get(), f);
        return 0;
      }
      evaluate();
      if (!all_finite(entries(f), d.space_.length())) {
        d.rate_not_finite_ = true;
        return 1;
      }
      if (at_start) {
        N_VScale(1.0, f, start.value.get());
        start.known = true;
      }
      return 0;
    });
  }

  static int explicit_rate(double t, N_Vector y, N_Vector f, void* user) {
    ArkodeDriver& d = self(user);
    return rate(d, *d.tableau_.explicit_half, d.explicit_start_, t, f, [&] {
      if (d.parts_.has_explicit) {
        d.problem_->explicit_rate(t, entries(y), entries(f));
        ++d.counters_.explicit_evals;
      } else {
        N_VConst(0.0, f);
      }
    });
  }

  static int implicit_rate(double t, N_Vector y, N_Vector f, void* user) {
    ArkodeDriver& d = self(user);
    return rate(d, *d.tableau_.implicit_half, d.implicit_start_, t, f, [&] {
      d.problem_->implicit_rate(t, entries(y), entries(f));
      ++d.counters_.implicit_evals;
    });
  }

  static int weights(N_Vector, N_Vector w, void* user) {
    const ArkodeDriver& d = self(user);
    d.space_.norm().weights(entries(d.y_), entries(w));
    return 0;
  }

  static void complaint(int, const char*, const char*, char* text, void* user) { self(user).message_ = text; }

  static SUNLinearSolver_Type solver_type(SUNLinearSolver) { return SUNLINEARSOLVER_MATRIX_EMBEDDED; }

  static int solve(SUNLinearSolver solver, SUNMatrix, N_Vector x, N_Vector b, double) {
    ArkodeDriver& d = self(solver->content);
    return guarded(d, [&]() -> int {
      double t = 0, gamma = 0;
      N_Vector guess, z, f, known;
      void* user;
      d.check(ARKStepGetNonlinearSystemData(d.mem_.get(), &t, &guess, &z, &f, &gamma, &known, &user),
              "ARKStepGetNonlinearSystemData");
      N_VScale(1.0, b, x);
      ++d.counters_.linear_solves;
      if (d.problem_->solve_implicit(t, entries(z), gamma, entries(x))) return SUNLS_SUCCESS;
      d.solver_failed_ = true;
      return SUNLS_CONV_FAIL;
    });
  }

  static SUNNonlinearSolver_Type stage_solver_type(SUNNonlinearSolver) { return SUNNONLINEARSOLVER_ROOTFIND; }
  static int set_system(SUNNonlinearSolver, SUNNonlinSolSysFn) { return SUN_NLS_SUCCESS; }

  /// Solves z - gamma f_I(t, z) = guess + data for a stage z = guess + correction.
  static int solve_stage(SUNNonlinearSolver solver, N_Vector, N_Vector correction, N_Vector, double,
                         booleantype, void*) {
    ArkodeDriver& d = self(solver->content);
    return guarded(d, [&]() -> int {
      double t = 0, gamma = 0;
      N_Vector guess, z, f, data;
      void* user;
      d.check(ARKStepGetNonlinearSystemData(d.mem_.get(), &t, &guess, &z, &f, &gamma, &data, &user),
              "ARKStepGetNonlinearSystemData");
      N_VLinearSum(1.0, guess, 1.0, data, d.known_.get());
      N_VScale(1.0, guess, z);
      ++d.counters_.linear_solves;
      if (d.problem_->solve_linear(t, gamma, entries(d.known_.get()), entries(z))) {
        N_VLinearSum(1.0, z, -1.0, guess, correction);
        return SUN_NLS_SUCCESS;
      }
      d.solver_failed_ = true;
      return SUN_NLS_CONV_RECVR;
    });
  }
};

ArkodeDriver::ArkodeDriver(SUNContext context, VectorSpace& space, const Tableau& tableau, const Parts& parts,
                           bool estimate_error, IntegratorCounters& counters)
    : space_(space),
      tableau_(tableau),
      parts_(parts),
      explicit_rates_(tableau.explicit_half && (parts.has_explicit || !parts.has_implicit)),
      implicit_rates_(parts.has_implicit || !tableau.explicit_half),
      estimate_error_(estimate_error),
      counters_(counters),
      scratch_(space.take()) {
  message_.reserve(1024);  // ARKODE complains of every rejected step; this must not allocate
  explicit_start_.value.reset(space.take());
  implicit_start_.value.reset(space.take());
  create(context);
}

ArkodeDriver::~ArkodeDriver() = default;

void ArkodeDriver::FreeMemory::operator()(void* mem) const {
  ARKStepFree(&mem);
}

void ArkodeDriver::check(int code, const char* call) const {
  if (code < 0)
    throw NumericalFailure(fmt::format("time integrator: {} failed with code {}: {}", call, code,
                                       message_.empty() ? "no message" : message_));
}

void ArkodeDriver::create(SUNContext context) {
  N_VConst(0.0, scratch_.get());
  mem_.reset(ARKStepCreate(explicit_rates_ ? Callbacks::explicit_rate : nullptr,
                           implicit_rates_ ? Callbacks::implicit_rate : nullptr, 0.0, scratch_.get(),
                           context));
  if (mem_ == nullptr) throw NumericalFailure("time integrator: ARKStepCreate failed");
  void* m = mem_.get();
  check(ARKStepSetErrHandlerFn(m, Callbacks::complaint, this), "ARKStepSetErrHandlerFn");
  check(ARKStepSetUserData(m, this), "ARKStepSetUserData");
  check(ARKStepWFtolerances(m, Callbacks::weights), "ARKStepWFtolerances");
  // Hermite interpolation would evaluate both rates once more after every step; nothing interpolates here.
  check(ARKStepSetInterpolantType(m, ARK_INTERP_LAGRANGE), "ARKStepSetInterpolantType");
  check(ARKStepSetInterpolantDegree(m, 0), "ARKStepSetInterpolantDegree");
  check(ARKStepSetTables(m, tableau_.order, tableau_.embedding_order,
                         implicit_rates_ ? tableau_.implicit_half.get() : nullptr,
                         explicit_rates_ ? tableau_.explicit_half.get() : nullptr),
        "ARKStepSetTables");
  // A failed attempt comes back at once: the caller chooses the next length.
  check(ARKStepSetMaxErrTestFails(m, 1), "ARKStepSetMaxErrTestFails");
  check(ARKStepSetMaxConvFails(m, 1), "ARKStepSetMaxConvFails");
  if (!implicit_rates_) return;
  if (parts_.implicit_is_linear)
    create_stage_solver(context);
  else
    create_newton(context);
}

void ArkodeDriver::create_newton(SUNContext context) {
  void* m = mem_.get();
  solver_.reset(SUNLinSolNewEmpty(context));
  if (solver_ == nullptr) throw NumericalFailure("time integrator: SUNLinSolNewEmpty failed");
  solver_->content = this;
  solver_->ops->gettype = Callbacks::solver_type;
  solver_->ops->solve = Callbacks::solve;
  check(ARKStepSetLinearSolver(m, solver_.get(), nullptr), "ARKStepSetLinearSolver");
  // ARKODE leaves out solves whose right-hand side is below this fraction of the tolerance; solve them all.
  check(ARKStepSetEpsLin(m, 1e-30), "ARKStepSetEpsLin");
  check(ARKStepSetNonlinConvCoef(m, kNewtonFraction), "ARKStepSetNonlinConvCoef");
  check(ARKStepSetMaxNonlinIters(m, kNewtonIterations), "ARKStepSetMaxNonlinIters");
}

/// A linear implicit part needs no residuals and no Jacobian: the stage is solved at once, and its rate
/// follows from it.
void ArkodeDriver::create_stage_solver(SUNContext context) {
  void* m = mem_.get();
  known_.reset(space_.take());
  stage_solver_.reset(SUNNonlinSolNewEmpty(context));
  if (stage_solver_ == nullptr) throw NumericalFailure("time integrator: SUNNonlinSolNewEmpty failed");
  stage_solver_->content = this;
  stage_solver_->ops->gettype = Callbacks::stage_solver_type;
  stage_solver_->ops->setsysfn = Callbacks::set_system;
  stage_solver_->ops->solve = Callbacks::solve_stage;
  check(ARKStepSetNonlinearSolver(m, stage_solver_.get()), "ARKStepSetNonlinearSolver");
  check(ARKStepSetDeduceImplicitRhs(m, 1), "ARKStepSetDeduceImplicitRhs");
}

void ArkodeDriver::begin(OdeProblem& problem, double t, N_Vector y) {
  problem_ = &problem;
  t_ = t;
  y_ = y;
  explicit_start_.known = implicit_start_.known = false;
}

Attempt ArkodeDriver::advance(double h, N_Vector y_new) {
  void* m = mem_.get();
  h_ = h;
  rate_not_finite_ = solver_failed_ = false;
  thrown_ = nullptr;
  message_.clear();
  check(ARKStepReset(m, t_, y_), "ARKStepReset");
  if (estimate_error_)
    check(ARKStepSetInitStep(m, h), "ARKStepSetInitStep");
  else
    check(ARKStepSetFixedStep(m, h), "ARKStepSetFixedStep");
  double reached = t_;
  const int code = ARKStepEvolve(m, t_ + 2 * h, y_new, &reached, ARK_ONE_STEP);
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
  return judge(code, y_new);
}

Attempt ArkodeDriver::judge(int code, N_Vector y_new) {
  if (code != ARK_SUCCESS && rate_not_finite_) return {Outcome::not_finite};
  if (code != ARK_SUCCESS && (solver_failed_ || code == ARK_CONV_FAILURE)) return {Outcome::not_converged};
  if (code != ARK_ERR_FAILURE) check(code, "ARKStepEvolve");

  Attempt a;
  if (estimate_error_) {
    check(ARKStepGetEstLocalErrors(mem_.get(), scratch_.get()), "ARKStepGetEstLocalErrors");
    a.error = space_.norm().at(entries(y_), entries(scratch_.get()));
    if (!std::isfinite(a.error)) return {Outcome::not_finite};
  }
  if (code == ARK_ERR_FAILURE)
    a.outcome = Outcome::inaccurate;
  else if (!all_finite(entries(y_new), space_.length()))
    a.outcome = Outcome::not_finite;
  return a;
}

}  // namespace meltray::integration
