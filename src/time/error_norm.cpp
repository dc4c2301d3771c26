// SPDX-License-Identifier: MIT
#include "time/error_norm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "meltray/core/errors.hpp"
#include "meltray/core/parallel.hpp"
#include "time/sweep.hpp"

namespace meltray::integration {

void ErrorNorm::set(std::span<const StateField> fields, std::size_t length) {
  parts_.clear();
  length_ = length;
  std::size_t end = 0;
  for (const StateField& f : fields) {
    if (f.begin != end)
      throw UsageError(fmt::format("state field '{}' begins at entry {}, expected {}", f.name, f.begin, end));
    if (!f.active.empty() && f.active.size() != f.size)
      throw UsageError(fmt::format("state field '{}' has {} entries but {} activity marks", f.name, f.size,
                                   f.active.size()));
    if (!(f.rtol >= 0) || !(f.atol > 0) || !std::isfinite(f.rtol) || !std::isfinite(f.atol))
      throw UsageError(
          fmt::format("tolerances of state field '{}': rtol = {}, atol = {}; rtol >= 0 and atol > 0 "
                      "are needed, because entries pass through zero",
                      f.name, f.rtol, f.atol));
    const auto idle = std::count(f.active.begin(), f.active.end(), std::uint8_t{0});
    parts_.push_back({f.begin, f.size, f.size - static_cast<std::size_t>(idle), f.rtol, f.atol,
                      idle > 0 ? f.active.data() : nullptr});
    end += f.size;
  }
  if (end != length)
    throw UsageError(fmt::format("state fields cover {} entries of a state of {}", end, length));
}

void ErrorNorm::weights(const double* y, double* w) const {
  for (const Part& p : parts_) {
    const double* yp = y + p.begin;
    double* wp = w + p.begin;
    const double rtol = p.rtol, atol = p.atol;
    const std::uint8_t* active = p.active;
    if (active == nullptr)
      sweep(p.size, [=](std::ptrdiff_t i) { wp[i] = 1.0 / (rtol * std::abs(yp[i]) + atol); });
    else
      sweep(p.size,
            [=](std::ptrdiff_t i) { wp[i] = active[i] != 0 ? 1.0 / (rtol * std::abs(yp[i]) + atol) : 0.0; });
  }
}

/// The largest of the fields' norms, where square_sum(part) sums the squares of a field's weighted entries.
template <class SquareSum>
double ErrorNorm::largest(SquareSum&& square_sum) const {
  double largest = 0;
  for (const Part& p : parts_) {
    if (p.count == 0) continue;
    const double rms = std::sqrt(square_sum(p) / static_cast<double>(p.count));
    if (std::isnan(rms)) return rms;
    largest = std::max(largest, rms);
  }
  return largest;
}

double ErrorNorm::operator()(const double* e, const double* w) const {
  return largest([=](const Part& p) {
    const double *ep = e + p.begin, *wp = w + p.begin;
    return parallel_sum(static_cast<std::ptrdiff_t>(p.size), [=](std::ptrdiff_t i) {
      const double x = ep[i] * wp[i];
      return x * x;
    });
  });
}

double ErrorNorm::at(const double* y, const double* e) const {
  return largest([=](const Part& p) {
    const double *ep = e + p.begin, *yp = y + p.begin;
    const double rtol = p.rtol, atol = p.atol;
    const std::uint8_t* const active = p.active;
    const auto weighted = [=](std::ptrdiff_t i) { return ep[i] * (1.0 / (rtol * std::abs(yp[i]) + atol)); };
    const auto count = static_cast<std::ptrdiff_t>(p.size);
    // Without marks it is a loop of vector instructions, which sums in the order of the one above.
    if (active == nullptr)
      return parallel_sum(count, [=](std::ptrdiff_t i) {
        const double x = weighted(i);
        return x * x;
      });
    return parallel_sum(count, [=](std::ptrdiff_t i) {
      const double x = active[i] != 0 ? weighted(i) : 0.0;
      return x * x;
    });
  });
}

bool all_finite(const double* y, std::size_t n) {
  // 0 * y is 0 for a finite y and NaN otherwise; a sum vectorises where a test for each entry does not.
  return parallel_sum(static_cast<std::ptrdiff_t>(n), [=](std::ptrdiff_t i) { return 0.0 * y[i]; }) == 0.0;
}

}  // namespace meltray::integration
