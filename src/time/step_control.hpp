// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "meltray/core/archive.hpp"
#include "meltray/time/integrator.hpp"

namespace meltray::integration {

/// A length for the next attempt and what set it.
struct Wish {
  double length = 0;
  std::string_view reason = "initial";
};

/// Length that ends on t_stop without a tiny last step: all of the rest where it fits, half of it where it is
/// less than two steps. The reason becomes "output" where this shortens the step.
Wish land(const Wish& wish, double t, double t_stop);

/// Throws NumericalFailure where a stability limit at time t is not a length.
void require_limit(const StepLimit& limit, double t);

/// Throws NumericalFailure where a wish is below min_step or would not move the clock; the message gives the
/// cause, or the wish's reason where there is none.
void require_possible(const Wish& wish, double min_step, double t, const std::string& cause = {});

/// PI controller of the step length (Gustafsson 1991; Hairer and Wanner II, sect. IV.2):
/// dt_new = dt * safety * error^(-0.7/k) * previous error^(0.4/k), k the power of dt in the error estimate.
class StepController {
 public:
  explicit StepController(const IntegratorOptions& options) : options_(options) {}

  /// Length wanted for the next step; 0 before the first.
  const Wish& wish() const { return wish_; }
  /// Shorter length after an attempt whose error was too large.
  Wish after_rejection(double dt, double error, int exponent) const;
  /// Takes note of an accepted step of length dt that was wanted to be `wanted` (longer where cut to end on
  /// an output time). exponent 0: no error estimate.
  void accept(double dt, double wanted, double error, int exponent, int rejected);

  void archive(Archive& a);

 private:
  IntegratorOptions options_;
  Wish wish_;
  double last_error_ = 0;  // of the last step that was not cut; 0: none yet
};

}  // namespace meltray::integration
