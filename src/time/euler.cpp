// SPDX-License-Identifier: MIT
#include "time/euler.hpp"

#include <cmath>

namespace meltray::integration {
namespace {

/// Newton's method stops below this fraction of the tolerances, as in the Runge-Kutta methods.
constexpr double kNewtonFraction = 1e-3;
constexpr int kNewtonIterations = 10;

}  // namespace

ForwardBackwardEuler::ForwardBackwardEuler(VectorSpace& space, const Parts& parts,
                                           IntegratorCounters& counters)
    : space_(space),
      parts_(parts),
      counters_(counters),
      rate_(space.take()),
      predicted_(space.take()),
      correction_(space.take()) {}

void ForwardBackwardEuler::begin(OdeProblem& problem, double t, N_Vector y) {
  problem_ = &problem;
  t_ = t;
  y_ = y;
  rate_known_ = false;
}

Attempt ForwardBackwardEuler::advance(double h, N_Vector y_new) {
  if (parts_.has_explicit) {
    if (!rate_known_) {
      problem_->explicit_rate(t_, entries(y_), entries(rate_.get()));
      ++counters_.explicit_evals;
      if (!all_finite(entries(rate_.get()), space_.length())) return {Outcome::not_finite};
      rate_known_ = true;
    }
    N_VLinearSum(1.0, y_, h, rate_.get(), y_new);
  } else {
    N_VScale(1.0, y_, y_new);
  }
  if (!all_finite(entries(y_new), space_.length())) return {Outcome::not_finite};
  return {parts_.has_implicit ? solve(h, y_new) : Outcome::done};
}

/// y1 = y* + h f_I(t + h, y1), where y_new holds y*: at once where f_I is linear, else by Newton's method
/// from y*.
Outcome ForwardBackwardEuler::solve(double h, N_Vector y_new) {
  N_VScale(1.0, y_new, predicted_.get());
  if (parts_.implicit_is_linear) {
    ++counters_.linear_solves;
    if (!problem_->solve_linear(t_ + h, h, entries(predicted_.get()), entries(y_new)))
      return Outcome::not_converged;
    return all_finite(entries(y_new), space_.length()) ? Outcome::done : Outcome::not_finite;
  }
  N_Vector d = correction_.get();
  for (int k = 0; k < kNewtonIterations; ++k) {
    problem_->implicit_rate(t_ + h, entries(y_new), entries(d));
    ++counters_.implicit_evals;
    N_VLinearSum(h, d, 1.0, predicted_.get(), d);
    N_VLinearSum(1.0, d, -1.0, y_new, d);
    if (!all_finite(entries(d), space_.length())) return Outcome::not_finite;
    ++counters_.linear_solves;
    if (!problem_->solve_implicit(t_ + h, entries(y_new), h, entries(d))) return Outcome::not_converged;
    N_VLinearSum(1.0, y_new, 1.0, d, y_new);
    if (!all_finite(entries(y_new), space_.length())) return Outcome::not_finite;
    if (space_.norm().at(entries(y_), entries(d)) <= kNewtonFraction) return Outcome::done;
  }
  return Outcome::not_converged;
}

}  // namespace meltray::integration
