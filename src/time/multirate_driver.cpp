// SPDX-License-Identifier: MIT
#include "time/multirate_driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "meltray/core/errors.hpp"
#include "time/step_control.hpp"

namespace meltray::integration {
namespace {

/// Steps that differ by rounding only are the same step.
constexpr double kSame = 1e-9;

struct FreeCoupling {
  void operator()(MRIStepCoupling c) const { MRIStepCoupling_Free(c); }
};

}  // namespace

/// What ARKODE calls. No exception may pass through its C frames: it is kept and thrown again afterwards.
struct MultirateDriver::Callbacks {
  template <class F>
  static int guarded(MultirateDriver& d, F&& f) {
    try {
      return f() ? 0 : -1;
    } catch (...) {
      d.thrown_ = std::current_exception();
      return -1;
    }
  }
  static MultirateDriver& self(MRIStepInnerStepper stepper) {
    void* content = nullptr;
    MRIStepInnerStepper_GetContent(stepper, &content);
    return *static_cast<MultirateDriver*>(content);
  }

  static int slow(double t, N_Vector y, N_Vector f, void* user) {
    auto& d = *static_cast<MultirateDriver*>(user);
    return guarded(d, [&] { return d.slow_rate(t, y, f); });
  }
  static int evolve(MRIStepInnerStepper stepper, double from, double to, N_Vector y) {
    MultirateDriver& d = self(stepper);
    return guarded(d, [&] { return d.advance_fast(from, to, y); });
  }
  /// The fast rate that ARKODE asks for before and after a step would only serve interpolation.
  static int full(MRIStepInnerStepper, double, N_Vector, N_Vector f, int) {
    N_VConst(0.0, f);
    return 0;
  }
  /// Nothing is remembered between calls of evolve().
  static int reset(MRIStepInnerStepper, double, N_Vector) { return 0; }
  static int weights(N_Vector, N_Vector w, void* user) {
    const auto& d = *static_cast<MultirateDriver*>(user);
    d.space_.norm().weights(entries(d.y_), entries(w));
    return 0;
  }
  static void complaint(int, const char*, const char*, char* text, void* user) {
    static_cast<MultirateDriver*>(user)->message_ = text;
  }
};

MultirateDriver::MultirateDriver(SUNContext context, VectorSpace& space, const Tableau& fast,
                                 const Parts& parts, double fast_step, double min_step,
                                 IntegratorCounters& counters)
    : space_(space),
      fast_(fast),
      parts_(parts),
      largest_fast_step_(fast_step),
      min_step_(min_step),
      counters_(counters),
      stage_(space.take()) {
  message_.reserve(1024);
  for (int s = 0; s < fast_.explicit_half->stages; ++s) rates_.emplace_back(space.take());
  N_VConst(0.0, stage_.get());

  MRIStepInnerStepper inner = nullptr;
  check(MRIStepInnerStepper_Create(context, &inner), "MRIStepInnerStepper_Create");
  inner_.reset(inner);
  check(MRIStepInnerStepper_SetContent(inner, this), "MRIStepInnerStepper_SetContent");
  check(MRIStepInnerStepper_SetEvolveFn(inner, Callbacks::evolve), "MRIStepInnerStepper_SetEvolveFn");
  check(MRIStepInnerStepper_SetFullRhsFn(inner, Callbacks::full), "MRIStepInnerStepper_SetFullRhsFn");
  check(MRIStepInnerStepper_SetResetFn(inner, Callbacks::reset), "MRIStepInnerStepper_SetResetFn");

  mem_.reset(MRIStepCreate(Callbacks::slow, nullptr, 0.0, stage_.get(), inner, context));
  if (mem_ == nullptr) throw NumericalFailure("time integrator: MRIStepCreate failed");
  void* m = mem_.get();
  check(MRIStepSetErrHandlerFn(m, Callbacks::complaint, this), "MRIStepSetErrHandlerFn");
  check(MRIStepSetUserData(m, this), "MRIStepSetUserData");
  check(MRIStepWFtolerances(m, Callbacks::weights), "MRIStepWFtolerances");
  // Hermite interpolation would evaluate both rates once more after every step; nothing interpolates here.
  check(MRIStepSetInterpolantType(m, ARK_INTERP_LAGRANGE), "MRIStepSetInterpolantType");
  check(MRIStepSetInterpolantDegree(m, 0), "MRIStepSetInterpolantDegree");
  const std::unique_ptr<MRIStepCouplingMem, FreeCoupling> coupling(
      MRIStepCoupling_LoadTable(fast_.order == 4 ? ARKODE_MRI_GARK_ERK45a : ARKODE_MRI_GARK_ERK33a));
  check(MRIStepSetCoupling(m, coupling.get()), "MRIStepSetCoupling");
}

MultirateDriver::~MultirateDriver() = default;

void MultirateDriver::check(int code, const char* call) const {
  if (code < 0)
    throw NumericalFailure(fmt::format("time integrator: {} failed with code {}: {}", call, code,
                                       message_.empty() ? "no message" : message_));
}

bool MultirateDriver::fast_rate(double t, N_Vector y, N_Vector f) {
  if (!parts_.has_explicit) {
    N_VConst(0.0, f);
    return true;
  }
  problem_->explicit_rate(t, entries(y), entries(f));
  ++counters_.explicit_evals;
  not_finite_ = !all_finite(entries(f), space_.length());
  return !not_finite_;
}

bool MultirateDriver::slow_rate(double t, N_Vector y, N_Vector f) {
  // At the end of a step, where no slow stage stands, for a next one that goes on from it; here each begins
  // anew.
  if (t > end_ - kSame * (end_ - t_)) {
    N_VConst(0.0, f);
    return true;
  }
  problem_->implicit_rate(t, entries(y), entries(f));
  ++counters_.implicit_evals;
  not_finite_ = !all_finite(entries(f), space_.length());
  return !not_finite_;
}

bool MultirateDriver::advance_fast(double from, double to, N_Vector y) {
  const ARKodeButcherTableMem& table = *fast_.explicit_half;
  const double steps = std::max(1.0, std::ceil((to - from) / fast_step_ * (1 - kSame)));
  const double h = (to - from) / steps;
  for (double k = 0; k < steps; ++k) {
    const double t = from + k * h;
    for (int s = 0; s < table.stages; ++s) {
      if (stage_unused(table, s, false)) continue;
      N_VScale(1.0, y, stage_.get());
      for (int r = 0; r < s; ++r)
        if (table.A[s][r] != 0)
          N_VLinearSum(1.0, stage_.get(), h * table.A[s][r], rates_[r].get(), stage_.get());
      const double at = t + table.c[s] * h;
      if (!fast_rate(at, stage_.get(), rates_[s].get())) return false;
      check(MRIStepInnerStepper_AddForcing(inner_.get(), at, rates_[s].get()),
            "MRIStepInnerStepper_AddForcing");
    }
    for (int s = 0; s < table.stages; ++s)
      if (table.b[s] != 0) N_VLinearSum(1.0, y, h * table.b[s], rates_[s].get(), y);
  }
  return true;
}

double MultirateDriver::fast_limit(OdeProblem& problem, double t, N_Vector y) const {
  const StepLimit limit = largest_fast_step_ > 0 ? StepLimit{largest_fast_step_, "fast step"}
                                                 : problem.stable_step(t, entries(y));
  require_limit(limit, t);
  require_possible({limit.seconds, limit.name}, min_step_, t);
  return limit.seconds;
}

void MultirateDriver::begin(OdeProblem& problem, double t, N_Vector y) {
  problem_ = &problem;
  t_ = t;
  y_ = y;
  fast_step_ = fast_limit(problem, t, y);
}

Attempt MultirateDriver::advance(double h, N_Vector y_new) {
  void* m = mem_.get();
  not_finite_ = false;
  end_ = t_ + h;
  thrown_ = nullptr;
  message_.clear();
  check(MRIStepReset(m, t_, y_), "MRIStepReset");
  check(MRIStepSetFixedStep(m, h), "MRIStepSetFixedStep");
  // MRIStep begins its first stage with what the vector of the result holds.
  N_VScale(1.0, y_, y_new);
  double reached = t_;
  const int code = MRIStepEvolve(m, t_ + 2 * h, y_new, &reached, ARK_ONE_STEP);
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
  if (not_finite_) return {Outcome::not_finite};
  check(code, "MRIStepEvolve");
  return {all_finite(entries(y_new), space_.length()) ? Outcome::done : Outcome::not_finite};
}

}  // namespace meltray::integration
