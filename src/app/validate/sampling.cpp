// SPDX-License-Identifier: MIT
#include "app/validate/sampling.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace meltray::app {

double sample(const Particles& p, const Vec3& point, double radius,
              const std::function<double(std::size_t)>& field) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_wall(i)) continue;
    const double x = p.x[0][i] - point[0], z = p.x[1][i] - point[1], r = std::hypot(x, z) / radius;
    if (r >= 1) continue;
    const Eigen::Vector3d row(1, x, z);
    const double weight = (1 - r) * (1 - r);
    normal += weight * row * row.transpose();
    right += weight * field(i) * row;
  }
  return normal.ldlt().solve(right)[0];
}

Peak peak(const std::function<double(double)>& f, double low, double high, int count) {
  const double step = (high - low) / (count - 1);
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(f(low + k * step));
  const auto best = static_cast<int>(std::max_element(values.begin(), values.end()) - values.begin());
  const int k = std::clamp(best, 1, count - 2);
  const double a = values[k - 1], b = values[k], c = values[k + 1];
  const double bend = a - 2 * b + c, shift = bend < 0 ? 0.5 * (a - c) / bend : 0.0;
  if (best != k) return {values[best], low + best * step};
  return {b - 0.25 * (a - c) * shift, low + (k + shift) * step};
}

double slope_of_line(const std::map<double, double>& values) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [at, value] : values) {
    n += 1;
    x += at;
    y += value;
    xx += at * at;
    xy += at * value;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

}  // namespace meltray::app
