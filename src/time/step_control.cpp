// SPDX-License-Identifier: MIT
#include "time/step_control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "meltray/core/errors.hpp"

namespace meltray::integration {
namespace {

/// Steps that differ by rounding only are the same step.
constexpr double kSame = 1e-9;
/// Floor of the remembered error: a step that was far too accurate must not block the growth of the next.
constexpr double kErrorFloor = 1e-4;
constexpr double kLargestCut = 0.2;
constexpr std::string_view kReasons[] = {"initial", "error", "growth", "retry"};

}  // namespace

Wish land(const Wish& wish, double t, double t_stop) {
  const double rest = t_stop - t;
  if (rest <= wish.length * (1 + kSame))
    return {rest, rest < wish.length * (1 - kSame) ? std::string_view("output") : wish.reason};
  if (rest < 2 * wish.length * (1 - kSame)) return {rest / 2, "output"};
  return wish;
}

void require_limit(const StepLimit& limit, double t) {
  if (!(limit.seconds > 0))
    throw NumericalFailure(
        fmt::format("stability limit '{}' is {} s at t = {:.9g} s", limit.name, limit.seconds, t));
}

void require_possible(const Wish& wish, double min_step, double t, const std::string& cause) {
  const double clock = std::nextafter(std::abs(t), 1e300) - std::abs(t);
  if (wish.length >= min_step && wish.length > clock) return;
  throw NumericalFailure(fmt::format(
      "time step of {:.3g} s at t = {:.9g} s is below the smallest allowed ({:.3g} s): {}", wish.length, t,
      std::max(min_step, clock), cause.empty() ? fmt::format("limited by '{}'", wish.reason) : cause));
}

Wish StepController::after_rejection(double dt, double error, int exponent) const {
  const double factor = options_.safety * std::pow(error, -1.0 / exponent);
  return {dt * std::clamp(factor, kLargestCut, options_.safety), "error"};
}

void StepController::accept(double dt, double wanted, double error, int exponent, int rejected) {
  const bool cut = dt < wanted * (1 - kSame);
  const double most = std::max(wanted, rejected > 0 ? dt : dt * options_.max_growth);
  double target = most;
  if (exponent > 0) {
    const double e = std::max(error, 1e-30);
    const double k = exponent;
    // No trend of the error is known at first, nor from a step that was cut: plain integral control.
    const double factor = cut || rejected > 0 || last_error_ == 0
                              ? std::pow(e, -1 / k)
                              : std::pow(e, -0.7 / k) * std::pow(last_error_, 0.4 / k);
    target = dt * options_.safety * factor;
    if (!cut) last_error_ = std::max(error, kErrorFloor);
  }
  if (target < most)
    wish_ = {target, "error"};
  else if (rejected > 0)
    wish_ = {most, "retry"};
  else if (most > wanted || !cut)
    wish_ = {most, "growth"};
  else
    wish_.length = most;  // as before the cut, for the same reason
}

void StepController::archive(Archive& a) {
  std::string reason(wish_.reason);
  a.value("integrator/proposed_step_s", wish_.length);
  a.value("integrator/proposed_reason", reason);
  a.value("integrator/last_error", last_error_);
  if (!a.loading()) return;
  const auto known = std::find(std::begin(kReasons), std::end(kReasons), reason);
  if (known == std::end(kReasons))
    throw UsageError("step controller: unknown reason '" + reason + "' in archive");
  wish_.reason = *known;
}

}  // namespace meltray::integration
