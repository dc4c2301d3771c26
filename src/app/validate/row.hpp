// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace meltray::app {

/// One quantity of a validation case at one resolution, against its reference. SI units; the quantity names
/// the unit where it has one.
struct Row {
  std::string id;  ///< of the case
  std::string quantity;
  std::string resolution;  ///< empty where nothing is discretised
  double value = 0, reference = 0;
  double error = 0;             ///< relative or absolute, as the case says
  double tolerance = 0;         ///< pass line of the error
  std::optional<double> goal;   ///< stricter than the pass line
  std::optional<double> order;  ///< observed, against the next coarser resolution
  double seconds = 0;           ///< of the run behind the row
  std::string source;           ///< of the reference
  std::string known_failure;    ///< why it misses its pass line, where that is known
  bool judged = true;           ///< false: reported only (a coarse resolution, a broken run's rest)

  bool passed() const { return !judged || error <= tolerance; }  // false for NaN
};

using Rows = std::vector<Row>;

/// What a row is measured with besides its numbers.
struct Measured {
  std::string resolution;
  double seconds = 0;
  std::string source;
};

/// |value - reference| / |reference| <= tolerance.
Row relative_row(std::string quantity, double value, double reference, double tolerance, const Measured& how);
/// |value - reference| <= tolerance.
Row absolute_row(std::string quantity, double value, double reference, double tolerance, const Measured& how);
/// 0 <= value <= limit: the value is itself an error.
Row limit_row(std::string quantity, double value, double limit, const Measured& how);

/// One quantity at several resolutions, coarse to fine, `scales[k]` being the spacing of `series[k]` in any
/// unit: sets the observed orders, judges the finest only, and appends all to `rows`.
void add_series(Rows& rows, const std::vector<double>& scales, Rows series);

/// Order of convergence between two resolutions with errors `coarse` and `fine`; nothing where one is zero.
std::optional<double> observed_order(double coarse, double fine, double ratio);

/// Stopwatch for `seconds`.
class Watch {
 public:
  Watch();
  double seconds() const;

 private:
  double start_;
};

}  // namespace meltray::app
