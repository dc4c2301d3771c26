// SPDX-License-Identifier: MIT
#include "time/explicit_driver.hpp"

#include <cmath>

namespace meltray::integration {

ExplicitDriver::ExplicitDriver(VectorSpace& space, const Tableau& tableau, const Parts& parts,
                               bool estimate_error, IntegratorCounters& counters)
    : space_(space),
      table_(*tableau.explicit_half),
      parts_(parts),
      estimate_error_(estimate_error),
      counters_(counters),
      implicit_rate_(space.take()) {
  for (int s = 0; s < table_.stages; ++s) rates_.emplace_back(space.take());
}

void ExplicitDriver::begin(OdeProblem& problem, double t, N_Vector y) {
  problem_ = &problem;
  t_ = t;
  y_ = y;
  start_known_ = false;
}

/// False where the rate is not finite.
bool ExplicitDriver::rate(double t, N_Vector y, N_Vector f) {
  if (parts_.has_explicit) {
    problem_->explicit_rate(t, entries(y), entries(f));
    ++counters_.explicit_evals;
  } else {
    N_VConst(0.0, f);
  }
  if (parts_.has_implicit) {
    problem_->implicit_rate(t, entries(y), entries(implicit_rate_.get()));
    ++counters_.implicit_evals;
    N_VLinearSum(1.0, f, 1.0, implicit_rate_.get(), f);
  }
  return all_finite(entries(f), space_.length());
}

/// y_new = y + h sum_r a[r] f_r over the first stages.
void ExplicitDriver::add_row(double h, const double* a, int stages, N_Vector y_new) {
  coefficient_.assign(1, 1.0);
  term_.assign(1, y_);
  for (int r = 0; r < stages; ++r) {
    coefficient_.push_back(h * a[r]);
    term_.push_back(rates_[r].get());
  }
  N_VLinearCombination(stages + 1, coefficient_.data(), term_.data(), y_new);
}

/// Norm of the error estimate of a step whose state has been found. It takes the place of the last stage's
/// rate.
double ExplicitDriver::error(double h) {
  coefficient_.clear();
  term_.clear();
  for (int r = 0; r < table_.stages; ++r) {
    coefficient_.push_back(h * (table_.b[r] - table_.d[r]));
    term_.push_back(rates_[r].get());
  }
  N_VLinearCombination(table_.stages, coefficient_.data(), term_.data(), rates_.back().get());
  return space_.norm().at(entries(y_), entries(rates_.back().get()));
}

Attempt ExplicitDriver::advance(double h, N_Vector y_new) {
  for (int s = 0; s < table_.stages; ++s) {
    if (stage_unused(table_, s, estimate_error_)) continue;
    if (s == 0) {
      if (!start_known_ && !rate(t_, y_, rates_[0].get())) return {Outcome::not_finite};
      start_known_ = true;
      continue;
    }
    add_row(h, table_.A[s], s, y_new);
    if (!rate(t_ + table_.c[s] * h, y_new, rates_[s].get())) return {Outcome::not_finite};
  }
  add_row(h, table_.b, table_.stages, y_new);

  Attempt a;
  if (estimate_error_) a.error = error(h);
  if (!std::isfinite(a.error) || !all_finite(entries(y_new), space_.length())) return {Outcome::not_finite};
  if (a.error > 1) a.outcome = Outcome::inaccurate;
  return a;
}

}  // namespace meltray::integration
