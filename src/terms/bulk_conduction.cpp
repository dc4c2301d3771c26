// SPDX-License-Identifier: MIT
#include "meltray/terms/bulk_conduction.hpp"

#include <cmath>

#include "meltray/terms/conduction.hpp"

namespace meltray::terms {

namespace {

constexpr double kAwake = 1e-3;         ///< [K] away from rest
constexpr double kExplicitShare = 0.5;  ///< of the Gershgorin limit per explicit sub-step

}  // namespace

void BulkConduction::build(const SceneConstants& constants, PatchSelector& selector,
                           const Particles& particles, double rest_temperature) {
  std::vector<Index> awake;
  for (Index i = 0; i < static_cast<Index>(particles.size()); ++i)
    if (!particles.is_liquid(i) && !particles.is_wall(i) && !particles.has(i, kRemoved) &&
        std::abs(particles.temperature[i] - rest_temperature) > kAwake)
      awake.push_back(i);
  selector.select_resting_near(particles, awake, patch_);
  const Index n = patch_.size();
  all_.assign(n, 1);
  for (Index i = 0; i < n; ++i) all_[i] = !patch_.wall[i];
  pairs_.build(patch_, selector.grid(), 0.0, all_);
  pairs_.refresh(patch_, constants.kernel);
  awake_.resize(n);
  for (Index i = 0; i < n; ++i)
    awake_[i] = std::abs(particles.temperature[patch_.global[i]] - rest_temperature) > kAwake;
  k_.assign(pairs_.pairs(), 0.0);
  const double scale = 1 / constants.lattice.second_moment;
  const auto& material = constants.material;
  sph::with_dim(constants.dim, [&](auto d) {
    constexpr int D = d;
    parallel_for(n, [&](Index i) {
      const double vi = patch_.mass[i] / constants.density, li = material.conductivity(patch_.h[i]);
      pairs_.for_row<D>(i, [&](const sph::Pair<D>& p) {
        if (patch_.wall[p.j] || !(awake_[i] || awake_[p.j])) return;
        k_[p.k] = conduction_coefficient(vi, patch_.mass[p.j] / constants.density, li,
                                         material.conductivity(patch_.h[p.j]), scale * p.f);
      });
    });
  });
  rate_ = parallel_max(n, 0.0, [&](std::ptrdiff_t i) {
    double sum = 0;
    for (Index q = pairs_.begin(i); q < pairs_.end(i); ++q) sum -= k_[q];
    return sum / patch_.mass[i] * material.temperature_slope(patch_.h[i]);
  });
}

void BulkConduction::exchange(const SceneConstants& constants, double dt,
                              const std::vector<std::uint8_t>& in_state, Particles& particles) {
  const Index n = patch_.size();
  temperature_.resize(n);
  gain_.resize(n);
  skip_.resize(n);
  const auto& material = constants.material;
  // 0: exchanges with everybody at rest; 1: only with partners outside the state; 2: melted since build().
  parallel_for(n, [&](Index i) {
    const Index g = patch_.global[i];
    skip_[i] = particles.is_liquid(g) ? 2 : in_state[g] ? 1 : 0;
    temperature_[i] = particles.temperature[g];
  });
  const int substeps = std::max(1, static_cast<int>(std::ceil(dt * rate_ / kExplicitShare)));
  const double step = dt / substeps;
  for (int s = 0; s < substeps; ++s) {
    parallel_for(n, [&](Index i) {
      double sum = 0;
      const double ti = temperature_[i];
      const int si = skip_[i];
      const Index last = pairs_.end(i);
#pragma omp simd reduction(+ : sum)
      for (Index q = pairs_.begin(i); q < last; ++q) {
        const Index j = pairs_.neighbour(q);
        const int both = si + skip_[j];
        sum += both < 2 ? k_[q] * (ti - temperature_[j]) : 0.0;
      }
      gain_[i] = si < 2 ? step * sum / patch_.mass[i] : 0.0;
    });
    parallel_for(n, [&](Index i) {
      if (gain_[i] == 0) return;
      const Index g = patch_.global[i];
      particles.h[g] += gain_[i];
      temperature_[i] = particles.temperature[g] = material.temperature(particles.h[g]);
    });
  }
}

std::size_t BulkConduction::bytes() const {
  return pairs_.bytes() + k_.capacity() * sizeof(double) + patch_.global.capacity() * 120;
}

}  // namespace meltray::terms
