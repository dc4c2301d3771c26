// SPDX-License-Identifier: MIT
#include "app/study/quantities.hpp"

#include <cmath>
#include <limits>

#include "meltray/observe/history.hpp"

namespace meltray::app::studies {
namespace {

template <class F>
void for_liquid(const Particles& p, F&& f) {
  for (std::size_t i = 0; i < p.size(); ++i)
    if (!p.is_wall(i) && p.is_liquid(i) && !p.has(i, kRemoved)) f(i);
}

Quantity temperatures(const scene::Simulation& s) {
  const Particles& p = s.particles();
  Quantity q{"temperature [K]", {}};
  for (std::size_t i = 0; i < p.size(); ++i)
    if (!p.is_wall(i)) q.values.push_back(s.scene().material.temperature(p.h[i]));
  return q;
}

Quantity velocities(const scene::Simulation& s) {
  const Particles& p = s.particles();
  Quantity q{"velocity [m/s]", {}};
  for_liquid(p, [&](std::size_t i) {
    for (int c = 0; c < p.dim; ++c) q.values.push_back(p.v[c][i]);
  });
  return q;
}

}  // namespace

Quantities no_quantities(const scene::Simulation&) {
  return {};
}

Quantities heat_quantities(const scene::Simulation& s) {
  const Particles& p = s.particles();
  double molten = 0;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (!p.is_wall(i)) molten += p.mass[i] * s.scene().material.liquid_fraction(p.h[i]);
  return {temperatures(s), {"molten mass [kg]", {molten}}};
}

Quantities flow_quantities(const scene::Simulation& s) {
  const Particles& p = s.particles();
  double energy = 0;
  for_liquid(p, [&](std::size_t i) {
    for (int c = 0; c < p.dim; ++c) energy += 0.5 * p.mass[i] * p.v[c][i] * p.v[c][i];
  });
  return {velocities(s), {"kinetic energy [J]", {energy}}};
}

Quantities convection_quantities(const scene::Simulation& s) {
  return {velocities(s), temperatures(s)};
}

Quantities drop_quantities(const scene::Simulation& s) {
  const Particles& p = s.particles();
  Vec3 second = Vec3::Zero();
  for_liquid(p, [&](std::size_t i) {
    for (int c = 0; c < p.dim; ++c) second[c] += p.x[c][i] * p.x[c][i];
  });
  return {velocities(s), {"height over width", {std::sqrt(second[p.dim - 1] / second[0])}}};
}

Quantities weld_quantities(const scene::Simulation& s) {
  const observe::HistoryRow row = observe::measure(s, {});
  return {{"capillary depth [m]", {row.capillary_depth}},
          {"axis depth [m]", {row.axis_depth}},
          {"absorbed energy [J]", {row.energy.laser}}};
}

double relative_error(const Quantity& q, const Quantity& reference) {
  const std::size_t n = reference.values.size();
  // Another number of entries: other particles have melted, the fields cannot be compared.
  if (n == 0 || q.values.size() != n) return std::numeric_limits<double>::infinity();
  double mean = 0;
  if (n > 1)
    for (double r : reference.values) mean += r / static_cast<double>(n);
  double error = 0, size = 0;
  for (std::size_t k = 0; k < n; ++k) {
    error += (q.values[k] - reference.values[k]) * (q.values[k] - reference.values[k]);
    size += (reference.values[k] - mean) * (reference.values[k] - mean);
  }
  const double ratio = std::sqrt(error / size);
  return std::isfinite(ratio) ? ratio : std::numeric_limits<double>::infinity();
}

Quantities mean(const std::vector<Quantities>& runs) {
  Quantities out = runs.front();
  for (std::size_t q = 0; q < out.size(); ++q)
    for (std::size_t k = 0; k < out[q].values.size(); ++k) {
      double sum = 0;
      for (const Quantities& run : runs) sum += run[q].values.at(k);
      out[q].values[k] = sum / static_cast<double>(runs.size());
    }
  return out;
}

}  // namespace meltray::app::studies
