// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "meltray/time/integrator.hpp"

namespace meltray::test {

inline std::vector<StateField> one_field(std::size_t n, double rtol, double atol) {
  return {{"y", 0, n, rtol, atol, {}}};
}

/// Manufactured nonlinear problem in two unknowns with solution s = (cos t, exp(-t/2)):
/// f_I = A(y), f_E = s' - A(s) + B(y) - B(s). Parts may be left out; s solves what remains.
struct Manufactured : OdeProblem {
  bool with_explicit = true, with_implicit = true, linear = false;

  static std::array<double, 2> exact(double t) { return {std::cos(t), std::exp(-t / 2)}; }
  static std::array<double, 2> slope(double t) { return {-std::sin(t), -std::exp(-t / 2) / 2}; }
  std::array<double, 2> a(const double* y) const {
    if (linear) return {-2 * y[0] + y[1], y[0] - 3 * y[1]};
    return {-y[0] * y[0] * y[0] + y[1], -y[1] * y[1] * y[0] - y[1]};
  }
  static std::array<double, 2> b(const double* y) { return {std::sin(y[0] * y[1]), y[0] * y[0]}; }

  bool has_explicit() const override { return with_explicit; }
  bool has_implicit() const override { return with_implicit; }
  bool implicit_is_linear() const override { return linear; }
  void explicit_rate(double t, const double* y, double* f) override {
    const auto s = exact(t), ds = slope(t), by = b(y), bs = b(s.data());
    const auto as = with_implicit ? a(s.data()) : std::array<double, 2>{};
    for (int i = 0; i < 2; ++i) f[i] = ds[i] - as[i] + by[i] - bs[i];
  }
  /// Without an explicit part the source terms stand here.
  void implicit_rate(double t, const double* y, double* f) override {
    const auto ay = a(y);
    f[0] = ay[0];
    f[1] = ay[1];
    if (with_explicit) return;
    const auto s = exact(t), ds = slope(t), as = a(s.data());
    for (int i = 0; i < 2; ++i) f[i] += ds[i] - as[i];
  }
  bool solve_implicit(double, const double* y, double gamma, double* x) override {
    double j[4] = {-3 * y[0] * y[0], 1, -y[1] * y[1], -2 * y[0] * y[1] - 1};
    if (linear) {
      j[0] = -2, j[1] = 1, j[2] = 1, j[3] = -3;
    }
    const double m00 = 1 - gamma * j[0], m01 = -gamma * j[1], m10 = -gamma * j[2], m11 = 1 - gamma * j[3];
    const double det = m00 * m11 - m01 * m10;
    const double x0 = (m11 * x[0] - m01 * x[1]) / det;
    x[1] = (m00 * x[1] - m10 * x[0]) / det;
    x[0] = x0;
    return true;
  }
  bool solve_linear(double t, double gamma, const double* known, double* z) override {
    const double rest[2] = {0, 0};
    double source[2];
    implicit_rate(t, rest, source);  // the part of f_I that is not linear in y
    for (int i = 0; i < 2; ++i) z[i] = known[i] + gamma * source[i];
    return solve_implicit(t, rest, gamma, z);
  }
  StepLimit stable_step(double, const double*) override { return {}; }

  static double error(double t, const std::vector<double>& y) {
    const auto s = exact(t);
    return std::hypot(y[0] - s[0], y[1] - s[1]);
  }
};

/// y_i' = -rate_i y_i, explicit, with a settable stability limit and faults on demand.
struct Decay : OdeProblem {
  std::vector<double> rates;
  StepLimit limit;
  double nan_after = std::numeric_limits<double>::infinity();  ///< rates at later times are NaN
  int nan_calls = 0;                                           ///< that many next calls give NaN
  int calls = 0;

  explicit Decay(std::vector<double> r) : rates(std::move(r)) {}
  bool has_implicit() const override { return false; }
  void explicit_rate(double t, const double* y, double* f) override {
    ++calls;
    for (std::size_t i = 0; i < rates.size(); ++i) f[i] = -rates[i] * y[i];
    if (t > nan_after || (nan_calls > 0 && nan_calls-- > 0)) f[0] = std::numeric_limits<double>::quiet_NaN();
  }
  void implicit_rate(double, const double*, double*) override {}
  bool solve_implicit(double, const double*, double, double*) override { return false; }
  StepLimit stable_step(double, const double*) override { return limit; }
};

/// Prothero and Robinson 1974: y' = -L (y - cos t) - sin t with solution cos t, the stiff term implicit;
/// beside it a non-stiff nonlinear unknown coupled to it, z' = -z^2 (2 + y) + g(t) with solution 1 + sin(t)
/// / 2.
struct Stiff : OdeProblem {
  double stiffness = 1e6;
  bool implicit_is_linear() const override { return true; }
  void explicit_rate(double t, const double* y, double* f) override {
    const double z = 1 + std::sin(t) / 2;
    f[0] = -std::sin(t);
    f[1] = std::cos(t) / 2 + z * z * (2 + std::cos(t)) - y[1] * y[1] * (2 + y[0]);
  }
  void implicit_rate(double t, const double* y, double* f) override {
    f[0] = -stiffness * (y[0] - std::cos(t));
    f[1] = 0;
  }
  bool solve_implicit(double, const double*, double gamma, double* x) override {
    x[0] /= 1 + gamma * stiffness;
    return true;
  }
  bool solve_linear(double t, double gamma, const double* known, double* z) override {
    z[0] = (known[0] + gamma * stiffness * std::cos(t)) / (1 + gamma * stiffness);
    z[1] = known[1];
    return true;
  }
  StepLimit stable_step(double, const double*) override { return {}; }
};

}  // namespace meltray::test
