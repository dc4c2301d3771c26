// SPDX-License-Identifier: MIT
#include <cmath>

#include "scene/simulation_impl.hpp"

/// What happens between steps: phases change, particles leave, cold solid exchanges heat.
namespace meltray::scene {

namespace {

/// Bulk conduction looks for newly warm particles every so many exchanges.
constexpr int kExchangesPerBuild = 10;
/// A melt particle nearer than this to a solid one solidifies on it [spacings].
constexpr double kContact = 1.5;

}  // namespace

bool Simulation::Impl::touches_solid(Index i) const {
  const double contact = kContact * constants.spacing;
  for (Index k = model.pairs.begin(i); k < model.pairs.end(i); ++k) {
    const Index j = model.pairs.neighbour(k);
    if (model.patch.liquid[j]) continue;
    double r2 = 0;
    for (int c = 0; c < constants.dim; ++c)
      r2 += std::pow(model.pairs.nearest(c, model.patch.x[c][i] - model.patch.x[c][j]), 2);
    if (r2 < contact * contact) return true;
  }
  return false;
}

/// Melting above the liquidus, solidification below the solidus on something solid (a drop in flight stays
/// liquid until it touches). Frozen over a step, updated between steps.
void Simulation::Impl::change_phases() {
  if (!scene.terms.melting) return;
  const auto timer = timers.measure(Part::phase);
  const double liquidus = constants.material.enthalpy_liquidus(),
               solidus = constants.material.enthalpy_solidus();
  for (Index i : model.stage.heated) {
    const Index g = model.patch.global[i];
    if (particles.has(g, kRemoved)) continue;
    const double h = model.patch.h[i];
    if (!model.patch.liquid[i] && h >= liquidus) {
      selector.melted(particles, g);
      particles.phase[g] = static_cast<std::uint8_t>(Phase::liquid);
      particles.flags[g] |= kWasLiquid;
      if (model.weakly_compressible()) particles.density[g] = model.density_on_melting(i);
      if (model.has_elastic_solid()) release(g);
      lists_valid = lists_valid && !model.flows();
      written = false;
    } else if (model.patch.liquid[i] && h <= solidus) {
      if (model.flows() && !touches_solid(i)) continue;
      for (int c = 0; c < constants.dim; ++c) {
        momentum.phase_change[c] -= particles.mass[g] * particles.v[c][g];
        if (!model.has_elastic_solid()) particles.v[c][g] = 0;
      }
      selector.solidified(particles, g);
      particles.phase[g] = static_cast<std::uint8_t>(Phase::solid);
      particles.flags[g] |= kResolidified;
      if (model.weakly_compressible())
        particles.density[g] = model.density_of_solid(particles.temperature[g]);
      if (model.has_elastic_solid()) particles.flags[g] |= kMobile;
      lists_valid = lists_valid && !model.flows();
      written = false;
    }
  }
}

/// Liquid that leaves the box through a free face is ejected. One that overshoots a wall by less than a
/// spacing is held at it, at the cost of its velocity into the wall (an impulse of the pressure), and counts
/// as clamped; farther behind it is a loss of the cropping and counts as removed. Periodic directions wrap
/// around.
void Simulation::Impl::remove_escaped() {
  const auto& moving = model.stage.moving;
  const auto left = [&](std::ptrdiff_t k) {
    for (int c = 0; c < constants.dim; ++c) {
      const double x = model.patch.x[c][moving[k]];
      if (x < scene.domain.min[c] || x > scene.domain.max[c]) return 1.0;
    }
    return 0.0;
  };
  if (parallel_max(static_cast<std::ptrdiff_t>(moving.size()), 0.0, left) == 0) return;
  for (Index i : moving) {
    const Index g = model.patch.global[i];
    bool outside = false, through_wall = false;
    for (int c = 0; c < constants.dim; ++c) {
      double& x = particles.x[c][g];
      const double period = selector.grid().period()[c];
      if (period > 0) {
        const double periods = std::floor((x - scene.domain.min[c]) / period);
        x -= period * periods;
        written = written && periods == 0;
        continue;
      }
      const bool below = x<scene.domain.min[c], above = x> scene.domain.max[c];
      if (!below && !above) continue;
      const int face = 2 * (constants.dim == 2 && c == 1 ? 2 : c) + (above ? 1 : 0);
      const double plane = above ? scene.domain.max[c] : scene.domain.min[c];
      if (scene.domain.faces[face].kind == FaceKind::wall && std::abs(x - plane) < constants.spacing) {
        const bool outwards = above == (particles.v[c][g] > 0);
        if (outwards) {
          momentum.pressure[c] -= particles.mass[g] * particles.v[c][g];
          particles.v[c][g] = 0;
        }
        x = plane;
        written = false;
        ++counters.clamped;
        continue;
      }
      outside = true;
      through_wall = through_wall || scene.domain.faces[face].kind == FaceKind::wall;
    }
    if (!outside) continue;
    particles.flags[g] |= kRemoved;
    (through_wall ? energy.cropped : energy.ejected) += particles.mass[g] * particles.h[g];
    (through_wall ? mass.cropped : mass.ejected) += particles.mass[g];
    ++(through_wall ? counters.removed : counters.ejected);
    for (int c = 0; c < constants.dim; ++c) momentum.ejected[c] += particles.mass[g] * particles.v[c][g];
    lists_valid = false;
  }
}

void Simulation::Impl::exchange_bulk(double until) {
  if (until < next_bulk) return;
  const auto timer = timers.measure(Part::heat);
  written = false;
  if (bulk_exchanges++ % kExchangesPerBuild == 0)
    bulk.build(constants, selector, particles, scene.heat.initial_temperature);
  bulk.exchange(constants, until - bulk_from, in_state, particles);
  bulk_from = until;
  next_bulk = until + scene.heat.bulk_interval;
}

}  // namespace meltray::scene
