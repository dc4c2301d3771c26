// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "app/validate/scenes.hpp"
#include "meltray/core/constants.hpp"

namespace meltray::app {
namespace {

constexpr double kRadius = 5e-4;
constexpr double kTemperature = 1900;

struct Drop {
  double jump = 0, reference = 0;  ///< pressure [Pa], mean over the last capillary time
  double capillary = 0;            ///< largest |u| mu / sigma in that time
  double speed = 0;                ///< largest |u| over sqrt(sigma / (rho R)) in that time
  double seconds = 0, per_radius = 0;
};

struct Instant {
  double pressure, speed;
};

/// Mean pressure farther than 3 h from the surface of the round drop, and the largest speed.
Instant look(const Particles& p, double radius) {
  Vec3 centre = Vec3::Zero();
  const auto n = static_cast<double>(p.size());
  for (std::size_t i = 0; i < p.size(); ++i)
    for (int c = 0; c < p.dim; ++c) centre[c] += p.x[static_cast<std::size_t>(c)][i] / n;
  double sum = 0, count = 0, fastest = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    double r2 = 0, v2 = 0;
    for (int c = 0; c < p.dim; ++c) {
      const auto k = static_cast<std::size_t>(c);
      r2 += std::pow(p.x[k][i] - centre[c], 2);
      v2 += p.v[k][i] * p.v[k][i];
    }
    fastest = std::max(fastest, v2);
    if (std::sqrt(r2) > radius - 3 * p.smoothing[i]) continue;
    sum += p.pressure[i];
    ++count;
  }
  return {sum / count, std::sqrt(fastest)};
}

/// A whole vector "[a,a]" or "[a,a,a]" for an override.
std::string vector_of(double a, int dim) {
  return dim == 2 ? fmt::format("[{},{}]", a, a) : fmt::format("[{},{},{}]", a, a, a);
}

Drop run(const Setting& setting, const char* metal, int dim, int per_radius, double capillary_times) {
  const Watch watch;
  const double box = 1.4 * kRadius;
  const auto simulation =
      start(setting, {fmt::format("material.name={}", metal), fmt::format("domain.dimension={}", dim),
                      fmt::format("domain.spacing_m={}", kRadius / per_radius),
                      "domain.min_m=" + vector_of(-box, dim), "domain.max_m=" + vector_of(box, dim),
                      "bodies.0.center_m=" + vector_of(0, dim), "bodies.0.radii_m=" + vector_of(kRadius, dim),
                      fmt::format("bodies.0.temperature_k={}", kTemperature)});
  const Material& m = simulation->scene().material;
  const double sigma = m.sigma(kTemperature), radius = equivalent_radius(simulation->particles(), m.density);
  const double unit = std::sqrt(m.density * std::pow(radius, 3) / sigma), end = capillary_times * unit;
  Drop drop;
  drop.per_radius = per_radius;
  drop.reference = (dim - 1) * sigma / radius;
  double weight = 0;
  advance(*simulation, end, [&, last = 0.0]() mutable {
    const double t = simulation->time(), dt = t - last;
    last = t;
    if (t < end - unit) return;
    const Instant now = look(simulation->particles(), radius);
    drop.jump += dt * now.pressure;
    drop.capillary = std::max(drop.capillary, now.speed * m.viscosity(kTemperature) / sigma);
    drop.speed = std::max(drop.speed, now.speed * unit / radius);
    weight += dt;
  });
  drop.jump /= weight;
  drop.seconds = watch.seconds();
  return drop;
}

void add_rows(const std::string& name, const Drop& d, const std::optional<Drop>& coarse, bool judged,
              Rows& rows) {
  const Measured how{fmt::format("R/dx {}", d.per_radius), d.seconds, "Laplace: sigma kappa"};
  Row jump = relative_row(name + ": interior pressure [Pa]", d.jump, d.reference, 0.03, how);
  // With the viscosity of the metal 1e-3 allows up to twice the capillary speed: that is reported beside it.
  Row capillary = limit_row(name + ": capillary number, spurious", d.capillary, 1e-3, how);
  Row speed = limit_row(name + ": spurious speed / sqrt(sigma / (rho R))", d.speed, 0, how);
  if (coarse) {
    const double ratio = d.per_radius / coarse->per_radius;
    jump.order = observed_order(std::abs(coarse->jump / coarse->reference - 1), jump.error, ratio);
    capillary.order = observed_order(coarse->capillary, d.capillary, ratio);
    speed.order = observed_order(coarse->speed, d.speed, ratio);
  }
  jump.judged = capillary.judged = judged;
  speed.judged = false;
  rows.insert(rows.end(), {jump, capillary, speed});
}

}  // namespace

Rows laplace_drop(const Setting& setting) {
  struct Variant {
    const char* name;
    const char* metal;
    int dim;
    std::vector<int> per_radius;
  };
  std::vector<Variant> variants = {{"Fe 2-D", "iron", 2, {10, 20, 40}},
                                   {"Al 2-D", "aluminium", 2, {10, 20}},
                                   {"Fe 3-D", "iron", 3, {10, 20}}};
  if (setting.small) variants = {{"Fe 2-D", "iron", 2, {20}}};
  Rows rows;
  for (const Variant& v : variants) {
    std::optional<Drop> coarse;
    for (const int per_radius : v.per_radius) {
      const Drop d = run(setting, v.metal, v.dim, per_radius, setting.small ? 2 : 6);
      add_rows(v.name, d, coarse, per_radius >= 20, rows);
      coarse = d;
    }
  }
  return rows;
}

}  // namespace meltray::app
