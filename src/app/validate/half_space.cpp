// SPDX-License-Identifier: MIT
#include "app/validate/half_space.hpp"

#include <array>
#include <cmath>

#include "meltray/core/constants.hpp"

namespace meltray::app {

double surface_temperature(const Particles& p, double spacing) {
  std::array<double, 2> sum{}, count{};
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto layer = static_cast<std::size_t>(p.x[0][i] / spacing);
    if (p.is_wall(i) || layer > 1) continue;
    sum[layer] += p.temperature[i];
    ++count[layer];
  }
  return 1.5 * sum[0] / count[0] - 0.5 * sum[1] / count[1];
}

CooledHalfSpace cool_half_space(double effusivity, double initial, double time, int steps,
                                const std::function<double(double)>& flux) {
  const double dt = time / steps, factor = std::sqrt(dt / constants::pi) / effusivity;
  // Over the interval that ended j steps ago the weights of its later and its earlier flux are
  // int_j^{j+1} (j + 1 - s) / sqrt(s) ds and int_j^{j+1} (s - j) / sqrt(s) ds.
  const auto moments = [](double j) {
    const double a = 2 * (std::sqrt(j + 1) - std::sqrt(j));
    const double b = 2.0 / 3 * (std::pow(j + 1, 1.5) - std::pow(j, 1.5));
    return std::array{(j + 1) * a - b, b - j * a};  // later, earlier
  };
  std::vector<double> q = {flux(initial)}, later, earlier;
  for (int j = 0; j < steps; ++j) {
    const auto [l, e] = moments(j);
    later.push_back(l);
    earlier.push_back(e);
  }
  CooledHalfSpace state{initial, 0};
  for (int n = 1; n <= steps; ++n) {
    double known = earlier[0] * q.back();
    for (int m = 1; m < n; ++m) known += later[n - m] * q[m] + earlier[n - m] * q[m - 1];
    const double start = initial - factor * known;
    // T + factor later_0 q(T) = start: bisection, as the left side rises with T.
    double low = start - factor * later[0] * flux(start), high = start;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (middle + factor * later[0] * flux(middle) < start ? low : high) = middle;
    }
    state.surface = high;
    q.push_back(flux(high));
    state.lost += 0.5 * dt * (q[n - 1] + q[n]);
  }
  return state;
}

}  // namespace meltray::app
