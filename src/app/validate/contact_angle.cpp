// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "app/validate/scenes.hpp"
#include "meltray/core/constants.hpp"

namespace meltray::app {
namespace {

constexpr double kDegree = constants::pi / 180;

/// A segment of a disc on a plane.
struct Sessile {
  double height = 0, base = 0;  ///< [m]
  double degrees = 0;           ///< angle to the plane
  double speed = 0;             ///< largest, over sigma / mu
  double area = 0;              ///< of all particles [m^2]
  double seconds = 0;
};

/// R of a segment of area A: A = R^2 (theta - sin theta cos theta); height R (1 - cos theta), base 2 R sin
/// theta.
Sessile segment(double degrees, double area) {
  const double theta = degrees * kDegree;
  const double radius = std::sqrt(area / (theta - std::sin(theta) * std::cos(theta)));
  return {radius * (1 - std::cos(theta)), 2 * radius * std::sin(theta), degrees};
}

/// The circle x^2 + z^2 = 2 a x + 2 b z + c through the outermost particles above the lowest two layers, by
/// least squares; the surface is half a spacing outside of it.
Sessile fit(const scene::Simulation& simulation) {
  const Particles& p = simulation.particles();
  const double spacing = simulation.scene().domain.spacing;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_wall(i) || !simulation.on_surface()[i] || p.x[1][i] < 2 * spacing) continue;
    const Eigen::Vector3d row(2 * p.x[0][i], 2 * p.x[1][i], 1);
    normal += row * row.transpose();
    right += (p.x[0][i] * p.x[0][i] + p.x[1][i] * p.x[1][i]) * row;
  }
  const Eigen::Vector3d abc = normal.ldlt().solve(right);
  const double z = abc[1], radius = std::sqrt(abc[2] + abc[0] * abc[0] + z * z) + 0.5 * spacing;
  return {z + radius, 2 * std::sqrt(radius * radius - z * z), std::acos(-z / radius) / kDegree};
}

Sessile run(const Setting& setting, double degrees, double spacing, double end) {
  const Watch watch;
  const auto simulation = start(setting, {fmt::format("domain.spacing_m={}", spacing),
                                          fmt::format("material.contact_angle_deg={}", degrees)});
  advance(*simulation, end);
  Sessile out = fit(*simulation);
  const Material& m = simulation->scene().material;
  out.speed = rms_speed(simulation->particles()) * m.viscosity(400) / m.sigma(400);
  for (std::size_t i = 0; i < simulation->particles().size(); ++i)
    if (!simulation->particles().is_wall(i)) out.area += spacing * spacing;
  out.seconds = watch.seconds();
  return out;
}

/// Drops of one angle at several spacings, by the angle that they take.
std::vector<Sessile> repeat(const Setting& setting, double degrees, const std::vector<double>& across) {
  std::vector<Sessile> drops;
  for (const double count : across)
    drops.push_back(run(setting, degrees, segment(degrees, 1).base / count, setting.small ? 4 : 8));
  std::sort(drops.begin(), drops.end(), [](const auto& a, const auto& b) { return a.degrees < b.degrees; });
  return drops;
}

}  // namespace

Rows contact_angle(const Setting& setting) {
  const std::vector<double> angles =
      setting.small ? std::vector<double>{90} : std::vector<double>{30, 90, 120};
  // Where the line of contact stops is decided by single particles: at 120 degrees it differs by 6 from one
  // spacing to the next, and so it does by rounding alone. The finest row is the median of five.
  const std::vector<std::vector<double>> resolutions =
      setting.small ? std::vector<std::vector<double>>{{20}}
                    : std::vector<std::vector<double>>{{20}, {30}, {36, 38, 40, 42, 44}};
  Rows rows;
  for (const double degrees : angles) {
    std::vector<double> spacings;
    Rows fitted, heights, bases;
    for (const std::vector<double>& across : resolutions) {
      const double middle = across[across.size() / 2];
      spacings.push_back(segment(degrees, 1).base / middle);
      const std::vector<Sessile> drops = repeat(setting, degrees, across);
      const Sessile& drop = drops[drops.size() / 2];
      // Of the particles' area, which differs a little from that of the half disc they fill.
      const Sessile exact = segment(degrees, drop.area);
      const std::string resolution = across.size() == 1
                                         ? fmt::format("base/dx {}", middle)
                                         : fmt::format("base/dx {}..{}", across.front(), across.back());
      double seconds = 0;
      for (const Sessile& d : drops) seconds += d.seconds;
      const Measured how{resolution, seconds, "segment of a disc"};
      const std::string name = fmt::format("{} deg: angle of the fitted circle [deg]", degrees);
      fitted.push_back(absolute_row(name, drop.degrees, degrees, 5, how));
      fitted.back().goal = 4;
      heights.push_back(
          relative_row(fmt::format("{} deg: height", degrees), drop.height, exact.height, 0.04, how));
      bases.push_back(relative_row(fmt::format("{} deg: base", degrees), drop.base, exact.base, 0, how));
      Rows reported{
          limit_row(fmt::format("{} deg: capillary number at the end", degrees), drop.speed, 1e-3, how)};
      if (drops.size() > 1) {
        reported.push_back(absolute_row(name + ", smallest", drops.front().degrees, degrees, 0, how));
        reported.push_back(absolute_row(name + ", largest", drops.back().degrees, degrees, 0, how));
      }
      for (Row& row : reported) {
        row.judged = false;
        rows.push_back(row);
      }
    }
    add_series(rows, spacings, fitted);
    add_series(rows, spacings, heights);
    add_series(rows, spacings, bases);
    rows.back().judged = false;  // no pass line of its own
  }
  return rows;
}

}  // namespace meltray::app
