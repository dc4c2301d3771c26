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
  double thrown = 0;            ///< share of them that has left the drop
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

struct Circle {
  double x = 0, z = 0, radius = 0;  ///< [m]
  double degrees() const { return std::acos(-z / radius) / kDegree; }
};

/// The circle x^2 + z^2 = 2 a x + 2 b z + c through the outermost particles above the lowest two layers, by
/// least squares; the surface is half a spacing outside of it.
Circle fitted_circle(const scene::Simulation& simulation) {
  const Particles& p = simulation.particles();
  const double spacing = simulation.scene().domain.spacing;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.is_liquid(i) || !simulation.on_surface()[i] || p.x[1][i] < 2 * spacing) continue;
    const Eigen::Vector3d row(2 * p.x[0][i], 2 * p.x[1][i], 1);
    normal += row * row.transpose();
    right += (p.x[0][i] * p.x[0][i] + p.x[1][i] * p.x[1][i]) * row;
  }
  const Eigen::Vector3d abc = normal.ldlt().solve(right);
  return {abc[0], abc[1], std::sqrt(abc[2] + abc[0] * abc[0] + abc[1] * abc[1]) + 0.5 * spacing};
}

/// Height of the topmost particle of the drop, width of the lowest layer, and area: of the particles, not of
/// a circle, which does not see what the drop has left behind on the plane. Thrown off is what is more than
/// two spacings above the plane and outside the circle.
Sessile extent(const scene::Simulation& simulation, const Circle& circle) {
  const Particles& p = simulation.particles();
  const double spacing = simulation.scene().domain.spacing;
  Sessile out;
  double left = 0, right = 0, liquid = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.is_liquid(i)) continue;
    ++liquid;
    const double x = p.x[0][i], z = p.x[1][i];
    if (z > 2 * spacing && std::hypot(x - circle.x, z - circle.z) > circle.radius + 2 * spacing) {
      ++out.thrown;
      continue;
    }
    out.height = std::max(out.height, z + 0.5 * spacing);
    if (z > spacing) continue;
    left = std::min(left, x);
    right = std::max(right, x);
  }
  out.area = liquid * spacing * spacing;
  out.thrown /= liquid;
  out.base = right - left + spacing;
  return out;
}

/// What the drop lies on: a face of the box, or four layers of its own solid.
enum class Ground { wall, own_solid };

Sessile run(const Setting& setting, const Target& target, Ground ground, double spacing, double end) {
  const Watch watch;
  scene::Overrides overrides = segment_body(target.start, 1);
  overrides.push_back(fmt::format("domain.spacing_m={}", spacing));
  overrides.push_back(fmt::format("material.contact_angle_deg={}", target.degrees));
  if (ground == Ground::own_solid) {  // whole layers, so that the slab's face lies between two of them
    for (const char* box : {"domain", "bodies.1"})
      overrides.push_back(fmt::format("{}.min_m=[-2.4,{}]", box, -4 * spacing));
    overrides.push_back(fmt::format("domain.max_m=[2.4,{}]", std::ceil(1.4 / spacing) * spacing));
  }
  const auto simulation = start(setting, overrides, ground == Ground::wall ? "case.toml" : "own_solid.toml");
  advance(*simulation, end);
  const Circle circle = fitted_circle(*simulation);
  Sessile out = extent(*simulation, circle);
  out.degrees = circle.degrees();
  const Material& m = simulation->scene().material;
  const double scale = m.sigma(400) / m.viscosity(400);
  out.speed = rms_speed(simulation->particles()) / scale;
  out.spreading = spreading_angle(target, out.area, spacing, scale, end);
  out.seconds = watch.seconds();
  return out;
}

/// Drops of one angle at several spacings, by the angle that they take.
std::vector<Sessile> repeat(const Setting& setting, const Target& target, Ground ground,
                            const std::vector<double>& across) {
  std::vector<Sessile> drops;
  for (const double count : across)
    drops.push_back(run(setting, target, ground, segment(target.degrees, 1).base / count, 8));
  std::sort(drops.begin(), drops.end(), [](const auto& a, const auto& b) { return a.degrees < b.degrees; });
  return drops;
}

/// Drops on one ground at some resolutions, each of which is one spacing or several that stand for one.
Rows drops_on(Ground ground, const Setting& setting, const std::vector<Target>& targets,
              const std::vector<std::vector<double>>& resolutions) {
  // The twin's lines are half of the way that its drops have to go, from 90 degrees and that height: they
  // tell an angle that is prescribed from none.
  const double degrees_line = setting.small ? 15 : 5, height_line = setting.small ? 0.08 : 0.04;
  Rows rows;
  for (const Target& target : targets) {
    const double degrees = target.degrees;
    const std::string drops_name =
        fmt::format("{} deg{}", degrees, ground == Ground::own_solid ? " on its own solid" : "");
    std::vector<double> spacings;
    Rows fitted, heights, bases;
    for (const std::vector<double>& across : resolutions) {
      const double middle = across[across.size() / 2];
      spacings.push_back(segment(degrees, 1).base / middle);
      const std::vector<Sessile> drops = repeat(setting, target, ground, across);
      const Sessile& drop = drops[drops.size() / 2];
      // Of the particles' area, which differs a little from that of the segment they fill.
      const Sessile exact = segment(degrees, drop.area);
      const std::string resolution = across.size() == 1
                                         ? fmt::format("base/dx {}", middle)
                                         : fmt::format("base/dx {}..{}", across.front(), across.back());
      double seconds = 0;
      for (const Sessile& d : drops) seconds += d.seconds;
      const Measured how{resolution, seconds, "segment of a disc"};
      const std::string name = fmt::format("{}: angle of the fitted circle [deg]", drops_name);
      fitted.push_back(absolute_row(name, drop.degrees, degrees, degrees_line, how));
      fitted.back().goal = 4;
      heights.push_back(relative_row(drops_name + ": height", drop.height, exact.height, height_line, how));
      bases.push_back(relative_row(drops_name + ": base", drop.base, exact.base, 0, how));
      Rows reported{limit_row(drops_name + ": capillary number at the end", drop.speed, 1e-3, how),
                    limit_row(drops_name + ": share thrown off", drop.thrown, 0, how),
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

}  // namespace

Rows contact_angle(const Setting& setting) {
  const std::vector<Target> targets = setting.small ? std::vector<Target>{{60, 90}, {120, 90}}
                                                    : std::vector<Target>{{30, 90}, {90, 120}, {120, 90}};
  // Where the line of contact stops is decided by single particles: at 120 degrees it differs by 6 from one
  // spacing to the next, and so it does by rounding alone. The finest row is the median of five.
  const std::vector<std::vector<double>> resolutions =
      setting.small ? std::vector<std::vector<double>>{{18, 19, 20, 21, 22}}
                    : std::vector<std::vector<double>>{{20}, {30}, {36, 38, 40, 42, 44}};
  Rows rows = drops_on(Ground::wall, setting, targets, resolutions);
  const std::vector<Target> on_solid =
      setting.small ? std::vector<Target>{{90, 120}} : std::vector<Target>{{60, 90}, {90, 120}, {120, 90}};
  for (const Row& row : drops_on(Ground::own_solid, setting, on_solid, {resolutions.back()}))
    rows.push_back(row);
  return rows;
}

}  // namespace meltray::app
