// SPDX-License-Identifier: MIT
#include "meltray/terms/bulk_conduction.hpp"

#include <cmath>

#include "meltray/core/memory.hpp"
#include "meltray/terms/conduction.hpp"

namespace meltray::terms {

namespace {

constexpr double kAwake = 0.05;         ///< [K] away from rest
constexpr double kExplicitShare = 0.5;  ///< of the Gershgorin limit per explicit sub-step

}  // namespace

void BulkConduction::build(const SceneConstants& constants, PatchSelector& selector,
                           const Particles& particles, double rest_temperature) {
  const auto rests = [&](Index g) { return std::abs(particles.temperature[g] - rest_temperature) <= kAwake; };
  std::vector<Index> awake;
  for (Index i = 0; i < static_cast<Index>(particles.size()); ++i)
    if (!rests(i) && !particles.is_liquid(i) && !particles.is_wall(i) && !particles.has(i, kRemoved))
      awake.push_back(i);
  selector.select_around(particles, awake, patch_);
  const Index n = patch_.size();
  std::vector<std::uint8_t> wanted(n);
  for (Index i = 0; i < n; ++i) wanted[i] = !patch_.wall[i];
  sph::PairList pairs;  // not kept: most of the warm particles of a weld are rows here
  pairs.build(patch_, selector.grid(), 0.0, wanted);
  assemble(constants, pairs, !particles.stress[0].empty(), rests);
}

/// Conductances of the pairs of which one at least is awake; the others are left out of the rows. `elastic`:
/// a scene whose solid has stresses.
template <class Rests>
void BulkConduction::assemble(const SceneConstants& constants, const sph::PairList& pairs, bool elastic,
                              Rests&& rests) {
  const Index n = patch_.size();
  const auto& material = constants.material;
  lambda_.resize(n);
  missing_.resize(n);
  at_rest_.resize(n);
  parallel_for(n, [&](Index i) {
    lambda_[i] = patch_.wall[i] ? 0.0 : material.conductivity(patch_.h[i]);
    at_rest_[i] = rests(patch_.global[i]);
  });
  // Melt and the faces of the box exchange their heat in the state.
  const auto solid = [&](Index i) { return !patch_.wall[i] && !patch_.liquid[i]; };
  const auto exchange_heat = [&](Index i, Index j) {
    return solid(i) && solid(j) && !(at_rest_[i] && at_rest_[j]);
  };
  start_.assign(n + 1, 0);
  parallel_for(n, [&](Index i) {
    for (Index q = pairs.begin(i); q < pairs.end(i); ++q)
      start_[i + 1] += exchange_heat(i, pairs.neighbour(q));
  });
  for (Index i = 0; i < n; ++i) start_[i + 1] += start_[i];
  resize_anew(neighbour_, start_[n]);
  resize_anew(k_, start_[n]);
  const double scale = 1 / constants.lattice.second_moment;
  sph::with_dim(constants.dim, [&](auto d) {
    constexpr int D = d;
    with_kernel<D>(constants.kernel, [&](auto kernel) {
      using Kernel = decltype(kernel);
      // As in the state: elastic solid has a density of its own.
      const auto volume = [&](Index i) {
        return patch_.mass[i] / (elastic ? patch_.density[i] : constants.density);
      };
      const auto distance = [&](Index i, Index j) {
        double r2 = 0;
        for (int c = 0; c < D; ++c) r2 += std::pow(pairs.nearest(c, patch_.x[c][i] - patch_.x[c][j]), 2);
        return std::sqrt(r2);
      };
      // Particles at rest count as inside: their neighbours need not all be in the patch.
      parallel_for(n, [&](Index i) {
        missing_[i] = 0;
        if (!solid(i) || at_rest_[i]) return;
        if (surrounded(pairs, i, constants.lattice)) return;
        double sum = volume(i) * Kernel::w(0.0, 1 / patch_.smoothing[i]);
        for (Index q = pairs.begin(i); q < pairs.end(i); ++q) {
          const Index j = pairs.neighbour(q);
          if (!patch_.wall[j])
            sum += volume(j) * Kernel::w(distance(i, j), 2 / (patch_.smoothing[i] + patch_.smoothing[j]));
        }
        missing_[i] = missing_layers(sum / constants.lattice.shepard, constants.lattice);
      });
      parallel_for(n, [&](Index i) {
        const double vi = volume(i), li = lambda_[i], hi = patch_.smoothing[i];
        Index out = start_[i];
        for (Index q = pairs.begin(i); q < pairs.end(i); ++q) {
          const Index j = pairs.neighbour(q);
          if (!exchange_heat(i, j)) continue;
          const double f = Kernel::f(distance(i, j), 2 / (hi + patch_.smoothing[j]));
          neighbour_[out] = j;
          // Rounded alike for (i, j) and (j, i), so that heat stays exact.
          k_[out++] = static_cast<float>(conduction_coefficient(vi, volume(j), li, lambda_[j], scale * f) *
                                         along_surface(missing_[i], missing_[j], constants.lattice));
        }
      });
    });
  });
  rate_ = parallel_max(n, 0.0, [&](std::ptrdiff_t i) {
    double sum = 0;
    for (Index q = start_[i]; q < start_[i + 1]; ++q) sum -= k_[q];
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
      const Index last = start_[i + 1];
#pragma omp simd reduction(+ : sum)
      for (Index q = start_[i]; q < last; ++q) {
        const Index j = neighbour_[q];
        const int both = si + skip_[j];
        sum += both < 2 ? static_cast<double>(k_[q]) * (ti - temperature_[j]) : 0.0;
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
  return patch_.bytes() +
         held_bytes(neighbour_, start_, k_, lambda_, missing_, temperature_, gain_, at_rest_, skip_);
}

}  // namespace meltray::terms
