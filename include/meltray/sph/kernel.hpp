// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace meltray::sph {

enum class KernelType { wendland_c2, cubic_spline };

/// Smoothing kernel W(r, h) of support 2h with its radial derivative divided by r, F = W'/r <= 0, so that
/// grad_a W_ab = F (x_a - x_b); F is finite at r = 0 and needs no division.
/// Wendland C2: W = alpha (1 - q/2)^4 (2q + 1), q = r/h; alpha = 7/(4 pi h^2) in 2-D, 21/(16 pi h^3) in 3-D.
template <int D>
struct WendlandC2 {
  static constexpr double kAlpha = D == 2 ? 7 / (4 * std::numbers::pi) : 21 / (16 * std::numbers::pi);

  static double w(double r, double inv_h) {
    const double q = r * inv_h, t = std::max(0.0, 1 - 0.5 * q), t2 = t * t;
    return scale(inv_h) * t2 * t2 * (2 * q + 1);
  }
  static double f(double r, double inv_h) {
    const double t = std::max(0.0, 1 - 0.5 * r * inv_h);
    return -5 * scale(inv_h) * inv_h * inv_h * t * t * t;
  }

 private:
  static double scale(double inv_h) {
    return D == 2 ? kAlpha * inv_h * inv_h : kAlpha * inv_h * inv_h * inv_h;
  }
};

/// Cubic spline of support 2h: alpha [(2-q)^3 - 4 (1-q)^3] / 6 with alpha = 15/(7 pi h^2), 3/(2 pi h^3).
template <int D>
struct CubicSpline {
  static constexpr double kAlpha = D == 2 ? 15 / (7 * std::numbers::pi) : 3 / (2 * std::numbers::pi);

  static double w(double r, double inv_h) {
    const double q = r * inv_h, a = std::max(0.0, 2 - q), b = std::max(0.0, 1 - q);
    return scale(inv_h) / 6 * (a * a * a - 4 * b * b * b);
  }
  static double f(double r, double inv_h) {
    // W'/r = alpha/h^2 * (-(2-q)^2/2 + 2 (1-q)^2)/q; for q < 1 the division cancels: -(2 - 3q/2).
    const double q = r * inv_h, a = std::max(0.0, 2 - q);
    const double outer = -0.5 * a * a / std::max(q, 1.0);
    return scale(inv_h) * inv_h * inv_h * (q < 1 ? -(2 - 1.5 * q) : outer);
  }

 private:
  static double scale(double inv_h) {
    return D == 2 ? kAlpha * inv_h * inv_h : kAlpha * inv_h * inv_h * inv_h;
  }
};

/// Calls f(kernel) with the kernel's type for a dimension chosen at run time.
template <int D, class F>
void with_kernel(KernelType type, F&& f) {
  if (type == KernelType::wendland_c2)
    f(WendlandC2<D>{});
  else
    f(CubicSpline<D>{});
}

}  // namespace meltray::sph
