// SPDX-License-Identifier: MIT
#include "app/validate/neumann.hpp"

#include <cmath>

#include "meltray/core/constants.hpp"

namespace meltray::app {

double Neumann::lambda() const {
  const double liquid = heat_capacity_liquid * (wall - melting) / latent_heat;
  const double solid = heat_capacity_solid * (melting - initial) / latent_heat;
  const double ratio = std::sqrt(diffusivity_liquid() / diffusivity_solid());
  // St_l / (e^(l^2) erf l) - St_s / (r e^(r^2 l^2) erfc(r l)) - l sqrt(pi), falling in l (A. & S.,
  // eq. 2.2.29).
  const auto excess = [&](double l) {
    return liquid / (std::exp(l * l) * std::erf(l)) -
           solid / (ratio * std::exp(ratio * ratio * l * l) * std::erfc(ratio * l)) -
           l * std::sqrt(constants::pi);
  };
  double low = 1e-6, high = 4;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (excess(middle) > 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double Neumann::front(double t) const {
  return 2 * lambda() * std::sqrt(diffusivity_liquid() * t);
}

double Neumann::temperature(double x, double t) const {
  const double l = lambda(), root = 2 * std::sqrt(diffusivity_liquid() * t);
  if (x < l * root) return wall - (wall - melting) * std::erf(x / root) / std::erf(l);
  const double a = diffusivity_solid();
  return initial + (melting - initial) * std::erfc(x / (2 * std::sqrt(a * t))) /
                       std::erfc(l * std::sqrt(diffusivity_liquid() / a));
}

}  // namespace meltray::app
