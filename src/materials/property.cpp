// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "meltray/materials/material.hpp"

namespace meltray {

double Property::operator()(double temperature) const {
  const double t = std::clamp(temperature, t_min, t_max);
  switch (form) {
    case Form::linear:
      return a + b * (t - t_ref);
    case Form::andrade:
      return std::pow(10.0, a + b / t);
    case Form::constant:
      break;
  }
  return a;
}

double Property::slope(double temperature) const {
  if (temperature < t_min || temperature > t_max) return 0;
  switch (form) {
    case Form::linear:
      return b;
    case Form::andrade:  // d/dT 10^(a + b/T)
      return -std::log(10.0) * b / (temperature * temperature) * (*this)(temperature);
    case Form::constant:
      break;
  }
  return 0;
}

}  // namespace meltray
