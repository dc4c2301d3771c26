// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>

#include "app/validate/sampling.hpp"
#include "app/validate/scenes.hpp"
#include "app/validate/table.hpp"

namespace meltray::app {
namespace {

constexpr double kMiddle = 400;  ///< mean of the wall temperatures [K]
constexpr double kHot = 400.5;

/// What de Vahl Davis compares; Nusselt numbers over conduction across the cavity at rest.
struct Cavity {
  Peak u, v;                                   ///< along x on x = 1/2, along z on z = 1/2
  double mean = 0;                             ///< Nusselt number, over the whole cavity
  double wall = 0, largest = 0, smallest = 0;  ///< Nusselt number on the hot wall
};

/// Heat across the cavity: convection of every particle and the conduction between the walls.
double mean_nusselt(const Particles& p) {
  double flow = 0, count = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_wall(i)) continue;
    flow += p.v[0][i] * (p.temperature[i] - kMiddle);
    ++count;
  }
  return 1 + flow / count;
}

/// -dT/dx at (0, z): T - T_hot = a x + b x^2 + c x (z_i - z) by least squares within `radius`.
double wall_nusselt(const Particles& p, double z, double radius) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_wall(i)) continue;
    const double x = p.x[0][i], dz = p.x[1][i] - z, r = std::hypot(x, dz) / radius;
    if (r >= 1) continue;
    const Eigen::Vector3d row(x, x * x, x * dz);
    normal += (1 - r) * (1 - r) * row * row.transpose();
    right += (1 - r) * (1 - r) * (p.temperature[i] - kHot) * row;
  }
  return -normal.ldlt().solve(right)[0];
}

Cavity look(const Particles& p, double spacing) {
  const double radius = 3 * spacing;
  const auto u = [&](double z) {
    return sample(p, {0.5, z, 0}, radius, [&](std::size_t i) { return p.v[0][i]; });
  };
  const auto v = [&](double x) {
    return sample(p, {x, 0.5, 0}, radius, [&](std::size_t i) { return p.v[1][i]; });
  };
  constexpr int kPoints = 41;
  Cavity out;
  out.u = peak(u, 0.5, 1 - spacing, kPoints);
  out.v = peak(v, spacing, 0.5, kPoints);
  out.mean = mean_nusselt(p);
  out.largest = 0;
  out.smallest = 1e300;
  for (int k = 0; k < kPoints; ++k) {
    const double nusselt = wall_nusselt(p, (k + 0.5) / kPoints, 4 * spacing);
    out.wall += nusselt / kPoints;
    out.largest = std::max(out.largest, nusselt);
    out.smallest = std::min(out.smallest, nusselt);
  }
  return out;
}

struct Result {
  Cavity mean;
  double seconds = 0;
};

/// Mean of twenty looks over the last fifth of the run.
Result run(const Setting& setting, double rayleigh, double fastest, double spacing, double end) {
  const Watch watch;
  const auto simulation = start(setting, {fmt::format("domain.spacing_m={}", spacing),
                                          fmt::format("domain.gravity_m_s2={}", rayleigh * 0.071),
                                          fmt::format("flow.drift_time_s={}", 5 * spacing / fastest),
                                          fmt::format("time.atol_velocity_m_s={}", 5e-3 * fastest)});
  constexpr int kLooks = 20;
  Result out;
  for (int k = 1; k <= kLooks; ++k) {
    advance(*simulation, end * (0.8 + 0.2 * k / kLooks));
    const Cavity now = look(simulation->particles(), spacing);
    for (const auto& [sum, value] : {std::pair{&out.mean.u, now.u}, {&out.mean.v, now.v}}) {
      sum->value += value.value / kLooks;
      sum->at += value.at / kLooks;
    }
    out.mean.mean += now.mean / kLooks;
    out.mean.wall += now.wall / kLooks;
    out.mean.largest += now.largest / kLooks;
    out.mean.smallest += now.smallest / kLooks;
  }
  out.seconds = watch.seconds();
  return out;
}

}  // namespace

Rows natural_convection(const Setting& setting) {
  const Table table(setting.folder / "reference.csv");
  const std::vector<double> spacings =
      setting.small ? std::vector<double>{0.05} : std::vector<double>{0.04, 0.02};
  // Conduction alone would fill the cavity in 1 / pi^2; convection is faster.
  const std::vector<double> ends =
      setting.small ? std::vector<double>{0.3} : std::vector<double>{0.4, 0.3, 0.2};
  Rows rows;
  for (std::size_t r = 0; r < ends.size(); ++r) {
    const auto of = [&](const char* column) { return table.number(r, column); };
    const std::string name = fmt::format("Ra {}: ", table.text(r, "ra"));
    std::vector<Rows> series(8);
    for (const double spacing : spacings) {
      const Result result = run(setting, of("ra"), of("v_max"), spacing, ends[r]);
      const Measured how{resolution_text(spacing), result.seconds, table.source()};
      const Cavity& c = result.mean;
      series[0].push_back(
          relative_row(name + "Nusselt number, mean", c.mean, of("nu_mean"), of("line"), how));
      series[0].back().goal = of("ra") < 2e4 ? 0.01 : 0.02;
      series[1].push_back(
          relative_row(name + "Nusselt number of the hot wall", c.wall, of("nu_mean"), 0, how));
      series[2].push_back(relative_row(name + "largest Nusselt number", c.largest, of("nu_max"), 0, how));
      series[3].push_back(relative_row(name + "smallest Nusselt number", c.smallest, of("nu_min"), 0, how));
      series[4].push_back(relative_row(name + "largest u on x = 1/2", c.u.value, of("u_max"), 0, how));
      series[5].push_back(absolute_row(name + "its place", c.u.at, of("u_at"), 0, how));
      series[6].push_back(relative_row(name + "largest v on z = 1/2", c.v.value, of("v_max"), 0, how));
      series[7].push_back(absolute_row(name + "its place", c.v.at, of("v_at"), 0, how));
    }
    for (std::size_t s = 0; s < series.size(); ++s) {
      add_series(rows, spacings, series[s]);
      rows.back().judged = s == 0;  // only the mean has a pass line
    }
  }
  return rows;
}

}  // namespace meltray::app
