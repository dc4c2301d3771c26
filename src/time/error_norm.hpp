// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "meltray/time/integrator.hpp"

namespace meltray::integration {

/// The norm documented at StateField: the largest over fields of the RMS of e_k w_k over active entries.
/// Inactive entries get weight 0, so that one weighted pass serves all fields.
class ErrorNorm {
 public:
  /// Takes over layout and tolerances. Throws UsageError when the fields do not cover [0, length) without
  /// gaps, or when a tolerance makes no sense.
  void set(std::span<const StateField> fields, std::size_t length);
  std::size_t length() const { return length_; }

  /// w_k = 1 / (rtol |y_k| + atol), 0 where inactive.
  void weights(const double* y, double* w) const;
  /// NaN when any weighted entry is NaN; 0 without active entries.
  double operator()(const double* e, const double* w) const;
  /// The same with the weights at y, which are nowhere stored.
  double at(const double* y, const double* e) const;

 private:
  struct Part {
    std::size_t begin, size, count;  // count: active entries
    double rtol, atol;
    const std::uint8_t* active;  // null: all
  };
  template <class SquareSum>
  double largest(SquareSum&& square_sum) const;
  std::vector<Part> parts_;
  std::size_t length_ = 0;
};

/// False as soon as one of the n entries is NaN or infinite.
bool all_finite(const double* y, std::size_t n);

}  // namespace meltray::integration
