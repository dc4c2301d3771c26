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
  double speed = 0;             ///< rms, over sigma / mu
  double area = 0;              ///< of all particles [m^2]
  double spreading = 0;         ///< angle of a drop that spreads after Cox and Voinov
  double seconds = 0;
};

/// An angle that is prescribed, and that of the segment the drop is at the start: another one, so that the
/// drop has to move.
struct Target {
  double degrees, start;
};

/// R of a segment of area A: A = R^2 (theta - sin theta cos theta).
double radius_of(double theta, double area) {
  return std::sqrt(area / (theta - std::sin(theta) * std::cos(theta)));
}

/// Height R (1 - cos theta), base 2 R sin theta.
Sessile segment(double degrees, double area) {
  const double theta = degrees * kDegree, radius = radius_of(theta, area);
  return {radius * (1 - std::cos(theta)), 2 * radius * std::sin(theta), degrees};
}

/// A disc whose part above the plane is the segment.
scene::Overrides segment_body(double degrees, double area) {
  const double theta = degrees * kDegree, radius = radius_of(theta, area);
  return {fmt::format("bodies.0.center_m=[0.0,{:.17g}]", -radius * std::cos(theta)),
          fmt::format("bodies.0.radii_m=[{0:.17g},{0:.17g}]", radius)};
}

/// Angle of a segment of constant area after a time, whose line of contact moves as in Cox 1986, Voinov 1976:
/// theta^3 - theta_e^3 = 9 (mu U / sigma) ln(a / dx). The slip length is the spacing, a half the base.
double spreading_angle(const Target& target, double area, double dx, double speed, double time) {
  constexpr int kSteps = 20000;
  const double rest = std::pow(target.degrees * kDegree, 3);
  const auto half_base = [&](double theta) { return radius_of(theta, area) * std::sin(theta); };
  double theta = target.start * kDegree;
  for (int k = 0; k < kSteps; ++k) {
    const double u = speed * (std::pow(theta, 3) - rest) / (9 * std::log(half_base(theta) / dx));
    const double slope = (half_base(theta + 1e-6) - half_base(theta - 1e-6)) / 2e-6;
    theta += time / kSteps * u / slope;
  }
  return theta / kDegree;
}

/// Angle of the circle x^2 + z^2 = 2 a x + 2 b z + c through the outermost particles above the lowest two
/// layers, by least squares; the surface is half a spacing outside of it.
double fitted_angle(const scene::Simulation& simulation) {
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
  return std::acos(-z / radius) / kDegree;
}

/// Height of the topmost particle, width of the lowest layer, and area: of the particles, not of a circle,
/// which does not see what the drop has left behind on the plane.
Sessile extent(const scene::Simulation& simulation) {
  const Particles& p = simulation.particles();
  const double spacing = simulation.scene().domain.spacing;
  Sessile out;
  double left = 0, right = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_wall(i)) continue;
    out.area += spacing * spacing;
    out.height = std::max(out.height, p.x[1][i] + 0.5 * spacing);
    if (p.x[1][i] > spacing) continue;
    left = std::min(left, p.x[0][i]);
    right = std::max(right, p.x[0][i]);
  }
  out.base = right - left + spacing;
  return out;
}

Sessile run(const Setting& setting, const Target& target, double spacing, double end) {
  const Watch watch;
  scene::Overrides overrides = segment_body(target.start, 1);
  overrides.push_back(fmt::format("domain.spacing_m={}", spacing));
  overrides.push_back(fmt::format("material.contact_angle_deg={}", target.degrees));
  const auto simulation = start(setting, overrides);
  advance(*simulation, end);
  Sessile out = extent(*simulation);
  out.degrees = fitted_angle(*simulation);
  const Material& m = simulation->scene().material;
  const double scale = m.sigma(400) / m.viscosity(400);
  out.speed = rms_speed(simulation->particles()) / scale;
  out.spreading = spreading_angle(target, out.area, spacing, scale, end);
  out.seconds = watch.seconds();
  return out;
}

/// Drops of one angle at several spacings, by the angle that they take.
std::vector<Sessile> repeat(const Setting& setting, const Target& target, const std::vector<double>& across) {
  std::vector<Sessile> drops;
  for (const double count : across)
    drops.push_back(run(setting, target, segment(target.degrees, 1).base / count, 8));
  std::sort(drops.begin(), drops.end(), [](const auto& a, const auto& b) { return a.degrees < b.degrees; });
  return drops;
}

}  // namespace

Rows contact_angle(const Setting& setting) {
  const std::vector<Target> targets = setting.small ? std::vector<Target>{{60, 90}, {120, 90}}
                                                    : std::vector<Target>{{30, 90}, {90, 120}, {120, 90}};
  // Where the line of contact stops is decided by single particles: at 120 degrees it differs by 6 from one
  // spacing to the next, and so it does by rounding alone. The finest row is the median of five.
  const std::vector<std::vector<double>> resolutions =
      setting.small ? std::vector<std::vector<double>>{{18, 19, 20, 21, 22}}
                    : std::vector<std::vector<double>>{{20}, {30}, {36, 38, 40, 42, 44}};
  // The twin's lines are half of the way that its drops have to go, from 90 degrees and that height: they
  // tell an angle that is prescribed from none.
  const double degrees_line = setting.small ? 15 : 5, height_line = setting.small ? 0.08 : 0.04;
  Rows rows;
  for (const Target& target : targets) {
    const double degrees = target.degrees;
    std::vector<double> spacings;
    Rows fitted, heights, bases;
    for (const std::vector<double>& across : resolutions) {
      const double middle = across[across.size() / 2];
      spacings.push_back(segment(degrees, 1).base / middle);
      const std::vector<Sessile> drops = repeat(setting, target, across);
      const Sessile& drop = drops[drops.size() / 2];
      // Of the particles' area, which differs a little from that of the segment they fill.
      const Sessile exact = segment(degrees, drop.area);
      const std::string resolution = across.size() == 1
                                         ? fmt::format("base/dx {}", middle)
                                         : fmt::format("base/dx {}..{}", across.front(), across.back());
      double seconds = 0;
      for (const Sessile& d : drops) seconds += d.seconds;
      const Measured how{resolution, seconds, "segment of a disc"};
      const std::string name = fmt::format("{} deg: angle of the fitted circle [deg]", degrees);
      fitted.push_back(absolute_row(name, drop.degrees, degrees, degrees_line, how));
      fitted.back().goal = 4;
      heights.push_back(
          relative_row(fmt::format("{} deg: height", degrees), drop.height, exact.height, height_line, how));
      bases.push_back(relative_row(fmt::format("{} deg: base", degrees), drop.base, exact.base, 0, how));
      Rows reported{
          limit_row(fmt::format("{} deg: capillary number at the end", degrees), drop.speed, 1e-3, how),
          absolute_row(name + ", spreading", drop.degrees, drop.spreading, 0,
                       {resolution, seconds, "Cox 1986, Voinov 1976"})};
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
