// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <vector>

#include "meltray/particles/particles.hpp"

namespace meltray::app {

/// Value at a point of the x-z plane of a field on the particles of a 2-D scene (dummies left out): plane
/// fitted by least squares with weights (1 - r / radius)^2.
double sample(const Particles& particles, const Vec3& point, double radius,
              const std::function<double(std::size_t)>& field);

/// Largest value of a function on [low, high], by a parabola through the largest of `count` samples and its
/// neighbours.
struct Peak {
  double value = 0, at = 0;
};
Peak peak(const std::function<double(double)>& f, double low, double high, int count);

/// Slope of the straight line through values over their places, by least squares; two places at least.
double slope_of_line(const std::map<double, double>& values);

}  // namespace meltray::app
