// SPDX-License-Identifier: MIT
#include "app/validate/row.hpp"

#include <chrono>
#include <cmath>

namespace meltray::app {
namespace {

Row row(std::string quantity, double value, double reference, double error, double tolerance,
        const Measured& how) {
  Row r;
  r.quantity = std::move(quantity);
  r.resolution = how.resolution;
  r.value = value;
  r.reference = reference;
  r.error = error;
  r.tolerance = tolerance;
  r.seconds = how.seconds;
  r.source = how.source;
  return r;
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Row relative_row(std::string quantity, double value, double reference, double tolerance,
                 const Measured& how) {
  const double error = std::abs(value - reference) / std::abs(reference);
  return row(std::move(quantity), value, reference, error, tolerance, how);
}

Row absolute_row(std::string quantity, double value, double reference, double tolerance,
                 const Measured& how) {
  return row(std::move(quantity), value, reference, std::abs(value - reference), tolerance, how);
}

Row limit_row(std::string quantity, double value, double limit, const Measured& how) {
  return row(std::move(quantity), value, 0, std::abs(value), limit, how);
}

void add_series(Rows& rows, const std::vector<double>& scales, Rows series) {
  for (std::size_t k = 0; k < series.size(); ++k) {
    series[k].judged = k + 1 == series.size();
    if (k > 0)
      series[k].order = observed_order(series[k - 1].error, series[k].error, scales[k - 1] / scales[k]);
  }
  rows.insert(rows.end(), series.begin(), series.end());
}

std::optional<double> observed_order(double coarse, double fine, double ratio) {
  if (!(coarse > 0) || !(fine > 0)) return std::nullopt;
  return std::log(coarse / fine) / std::log(ratio);
}

Watch::Watch() : start_(now()) {}
double Watch::seconds() const {
  return now() - start_;
}

}  // namespace meltray::app
