// SPDX-License-Identifier: MIT
#include "meltray/time/integrator.hpp"

#include <fmt/format.h>
#include <sundials/sundials_context.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "meltray/core/errors.hpp"
#include "time/arkode_driver.hpp"
#include "time/euler.hpp"
#include "time/explicit_driver.hpp"
#include "time/multirate_driver.hpp"
#include "time/step_control.hpp"
#include "time/sweep.hpp"

namespace meltray {

using integration::Attempt;
using integration::Outcome;
using integration::Parts;
using integration::Wish;

namespace {

struct FreeContext {
  void operator()(SUNContext c) const { SUNContext_Free(&c); }
};
using Context = std::unique_ptr<_SUNContext, FreeContext>;

Context make_context() {
  SUNContext c = nullptr;
  if (SUNContext_Create(nullptr, &c) != 0)
    throw NumericalFailure("time integrator: SUNContext_Create failed");
  return Context(c);
}

void require(bool condition, std::string_view key, double found, std::string_view allowed) {
  if (!condition)
    throw UsageError(fmt::format("time integration: {} = {}, allowed: {}", key, found, allowed));
}

const IntegratorOptions& validated(const IntegratorOptions& o) {
  require(o.fixed_step >= 0 && std::isfinite(o.fixed_step), "fixed_step", o.fixed_step, ">= 0");
  require(o.initial_step >= 0 && std::isfinite(o.initial_step), "initial_step", o.initial_step, ">= 0");
  require(o.min_step >= 0, "min_step", o.min_step, ">= 0");
  require(o.max_step > 0 && o.max_step >= o.min_step, "max_step", o.max_step, "> 0 and >= min_step");
  require(o.fixed_step == 0 || o.fixed_step >= o.min_step, "fixed_step", o.fixed_step, "0 or >= min_step");
  require(o.fast_step >= 0 && std::isfinite(o.fast_step), "fast_step", o.fast_step, ">= 0");
  require(o.method != Method::multirate || o.fixed_step > 0, "fixed_step", o.fixed_step,
          "> 0 with method 'multirate'");
  require(o.safety > 0 && o.safety < 1, "safety", o.safety, "between 0 and 1");
  require(o.max_growth > 1, "max_growth", o.max_growth, "> 1");
  return o;
}

/// Why an attempt failed; empty where it did not.
std::string cause(const Attempt& a) {
  switch (a.outcome) {
    case Outcome::inaccurate:
      return fmt::format("the error estimate was {:.3g} times the tolerance", a.error);
    case Outcome::not_finite:
      return "NaN or infinity in a rate or in the new state";
    case Outcome::not_converged:
      return "the implicit solve did not converge";
    case Outcome::done:
      break;
  }
  return {};
}

}  // namespace

struct Integrator::Impl {
  explicit Impl(const IntegratorOptions& o)
      : options(validated(o)), context(make_context()), space(context.get()), control(options) {
    if (options.method != Method::euler) tableau = integration::tableau(options.method, options.order);
  }

  StepReport step(OdeProblem& problem, std::span<const StateField> fields, double t, double t_stop,
                  std::vector<double>& y);

  bool controls_error() const { return options.fixed_step == 0 && tableau.order > 0; }
  void prepare(const OdeProblem& problem);
  Wish first_wish(OdeProblem& problem, double t, double t_stop, N_Vector y, const StepLimit& limit);
  Wish choose(OdeProblem& problem, double t, double t_stop, N_Vector y);

  IntegratorOptions options;
  Context context;
  integration::VectorSpace space;
  integration::Tableau tableau;
  integration::StepController control;
  IntegratorCounters counters;
  std::optional<Parts> parts;
  std::unique_ptr<integration::OneStep> stepper;
  integration::OwnedVector y_new;
};

/// Builds the stepper at the first step and whenever the problem has other parts than before.
void Integrator::Impl::prepare(const OdeProblem& problem) {
  const Parts now{problem.has_explicit(), problem.has_implicit(), problem.implicit_is_linear()};
  if (parts == now) return;
  if (options.method == Method::implicit_rk && now.has_explicit)
    throw UsageError(
        "method 'implicit' treats every term implicitly, but this problem has explicit terms: move them to "
        "the "
        "implicit part or choose method 'imex'");
  if (options.method == Method::multirate && !now.has_implicit)
    throw UsageError(
        "method 'multirate' needs a slow part, but this problem has none: choose method 'explicit'");
  stepper.reset();
  parts.reset();
  if (options.method == Method::euler)
    stepper = std::make_unique<integration::ForwardBackwardEuler>(space, now, counters);
  else if (options.method == Method::multirate)
    stepper = std::make_unique<integration::MultirateDriver>(context.get(), space, tableau, now,
                                                             options.fast_step, options.min_step, counters);
  else if (!tableau.implicit_half)
    stepper = std::make_unique<integration::ExplicitDriver>(space, tableau, now, controls_error(), counters);
  else
    stepper = std::make_unique<integration::ArkodeDriver>(context.get(), space, tableau, now,
                                                          controls_error(), counters);
  parts = now;
  if (!y_new) y_new.reset(space.take());
}

/// Without initial_step: the stability limit; where there is none, a step that changes the state by a
/// hundredth of its size (Hairer, Norsett and Wanner I, sect. II.4), where there is an error control to
/// correct it.
Wish Integrator::Impl::first_wish(OdeProblem& problem, double t, double t_stop, N_Vector start,
                                  const StepLimit& limit) {
  if (options.initial_step > 0) return {options.initial_step, "initial"};
  if (limit.seconds < t_stop - t || !controls_error()) return {1e300, "initial"};
  integration::OwnedVector rate(space.take()), part(space.take());
  N_VConst(0.0, rate.get());
  const double* y = integration::entries(start);
  if (problem.has_explicit()) {
    problem.explicit_rate(t, y, integration::entries(rate.get()));
    ++counters.explicit_evals;
  }
  if (problem.has_implicit()) {
    problem.implicit_rate(t, y, integration::entries(part.get()));
    ++counters.implicit_evals;
    N_VLinearSum(1.0, rate.get(), 1.0, part.get(), rate.get());
  }
  const double size = space.norm().at(y, y), speed = space.norm().at(y, integration::entries(rate.get()));
  const double guess = 0.01 * std::max(size, 1.0) / speed;
  return {std::isfinite(guess) && guess > 0 ? guess : 1e300, "initial"};
}

/// Length of the step before it is fitted to t_stop.
Wish Integrator::Impl::choose(OdeProblem& problem, double t, double t_stop, N_Vector y) {
  if (options.fixed_step > 0) return {options.fixed_step, "fixed"};
  const StepLimit limit = problem.stable_step(t, integration::entries(y));
  integration::require_limit(limit, t);
  Wish wish = control.wish().length > 0 ? control.wish() : first_wish(problem, t, t_stop, y, limit);
  if (options.max_step < wish.length) wish = {options.max_step, "maximum"};
  if (limit.seconds < wish.length) wish = {limit.seconds, limit.name};
  return wish;
}

StepReport Integrator::Impl::step(OdeProblem& problem, std::span<const StateField> fields, double t,
                                  double t_stop, std::vector<double>& y) {
  if (!(t_stop > t) || !std::isfinite(t))
    throw UsageError(fmt::format("time integration from {} s to {} s: the end must come later", t, t_stop));
  space.shape(fields, y.size());
  prepare(problem);
  const N_Vector start = space.view(y.data());
  if (!integration::all_finite(y.data(), y.size()))
    throw NumericalFailure(fmt::format("the state at the start of the step, t = {:.9g} s, is not finite", t));
  stepper->begin(problem, t, start);

  const int exponent = controls_error() ? tableau.error_exponent() : 0;
  StepReport report;
  Attempt last;
  Wish wanted = choose(problem, t, t_stop, start);
  for (;;) {
    integration::require_possible(wanted, options.min_step, t, cause(last));
    const Wish now = integration::land(wanted, t, t_stop);
    last = stepper->advance(now.length, y_new.get());
    if (last.outcome == Outcome::done) {
      report.t = now.length == t_stop - t ? t_stop : t + now.length;
      report.dt = now.length;
      report.limiter = now.reason;
      report.error = last.error;
      break;
    }
    ++report.rejected;
    ++counters.rejected;
    if (options.fixed_step > 0)
      throw NumericalFailure(
          fmt::format("fixed step of {:.3g} s at t = {:.9g} s failed: {}", now.length, t, cause(last)));
    wanted = last.outcome == Outcome::inaccurate ? control.after_rejection(now.length, last.error, exponent)
                                                 : Wish{now.length / 2, "retry"};
  }
  ++counters.steps;
  if (options.fixed_step == 0)
    control.accept(report.dt, wanted.length, report.error, exponent, report.rejected);
  const double* const result = integration::entries(y_new.get());
  double* const state = y.data();
  integration::sweep(y.size(), [=](std::ptrdiff_t i) { state[i] = result[i]; });
  return report;
}

Integrator::Integrator(const IntegratorOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Integrator::~Integrator() = default;
Integrator::Integrator(Integrator&&) noexcept = default;
Integrator& Integrator::operator=(Integrator&&) noexcept = default;

StepReport Integrator::step(OdeProblem& problem, std::span<const StateField> fields, double t, double t_stop,
                            std::vector<double>& y) {
  return impl_->step(problem, fields, t, t_stop, y);
}

const IntegratorCounters& Integrator::counters() const {
  return impl_->counters;
}

std::size_t Integrator::bytes(std::size_t entries) const {
  constexpr int kOfArkode = 12;  // besides the rates of the stages
  const auto& table = impl_->tableau;
  const int stages = (table.explicit_half ? table.explicit_half->stages : 0) +
                     (table.implicit_half ? table.implicit_half->stages : 0);
  const bool by_arkode = table.implicit_half || impl_->options.method == Method::multirate;
  // Of the forward-backward Euler method: three of its own. All: the new state.
  const int vectors = 1 + (stages > 0 ? stages : 3) + (by_arkode ? kOfArkode : 0);
  return std::max(impl_->space.bytes(), vectors * entries * sizeof(double));
}

void Integrator::release() {
  impl_->space.release();
}

double Integrator::proposed_step() const {
  if (impl_->options.fixed_step > 0) return impl_->options.fixed_step;
  const double proposed = impl_->control.wish().length;
  return proposed > 0 ? proposed : impl_->options.initial_step;
}

void Integrator::archive(Archive& a) {
  impl_->control.archive(a);
  IntegratorCounters& c = impl_->counters;
  a.value("integrator/steps", c.steps);
  a.value("integrator/rejected", c.rejected);
  a.value("integrator/explicit_evals", c.explicit_evals);
  a.value("integrator/implicit_evals", c.implicit_evals);
  a.value("integrator/linear_solves", c.linear_solves);
}

std::string_view name_of(Method m) {
  switch (m) {
    case Method::euler:
      return "euler";
    case Method::imex:
      return "imex";
    case Method::explicit_rk:
      return "explicit";
    case Method::implicit_rk:
      return "implicit";
    case Method::multirate:
      return "multirate";
  }
  return "";
}

}  // namespace meltray
