// SPDX-License-Identifier: MIT
#include "meltray/terms/conduction.hpp"

#include <cmath>

#include "meltray/core/memory.hpp"

namespace meltray::terms {

void ConductionOperator::assemble(const Stage& s) {
  const Index n = s.size();
  const auto& pairs = *s.pairs;
  conductivity_.resize(n);
  resize_anew(k_, pairs.slots());
  row_sum_.resize(n);
  wall_slope_.assign(n, 0.0);
  wall_power_.assign(n, 0.0);
  parallel_for(n, [&](Index i) {
    conductivity_[i] = s.heat[i] ? s.constants->material.conductivity(s.patch->h[i]) : 0.0;
  });
  find_missing_layers(s);
  const double scale = 1 / s.constants->lattice.second_moment;
  const double half = 0.5 * s.constants->spacing;
  const double layer = s.area_of_spacing();
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    const double* const volume = s.volume.data();
    const double *const lambda = conductivity_.data(), *const missing = missing_.data();
    const sph::LatticeSums& lattice = s.constants->lattice;
    parallel_for(static_cast<std::ptrdiff_t>(s.heated.size()), [&](std::ptrdiff_t row) {
      const Index i = s.heated[row];
      const double vi = volume[i], li = lambda[i], mi = missing[i];
      float* const k = k_.data();
      // A partner outside the state has conductivity 0 here, so that the pair exchanges nothing.
      pairs.for_lanes<D>(i, [&](const sph::PairLanes<D>& p) {
        const sph::Lanes lj = p.of(lambda);
        sph::store(k + p.k, (vi * p.of(volume)) * (li * lj) / (li + lj) * (4 * scale * p.f));
      });
      if (mi > 0)
        for (Index q = pairs.begin(i); q < pairs.end(i); ++q)
          k[q] *= static_cast<float>(along_surface(mi, missing[pairs.neighbour(q)], lattice));
      sph::Lanes sum = 0;
      for (Index q = pairs.begin(i); q < pairs.filled_end(i); q += sph::kLaneCount) sum += sph::load(k + q);
      row_sum_[i] = sph::sum(sum);
      double slope = 0, power = 0;
      if (s.constants->any_isothermal && pairs.next_to_wall()[i])
        pairs.for_row<D>(i, [&](const sph::Pair<D>& p) {
          if (!s.patch->wall[p.j]) return;
          const WallFace& face = s.constants->faces[s.patch->wall[p.j] - 1];
          if (!face.isothermal) return;
          const double di = std::max(std::abs(s.patch->x[face.axis][i] - face.plane), half);
          const double dj = std::abs(s.patch->x[face.axis][p.j] - face.plane);
          const double k_wall =
              conduction_coefficient(volume[i], volume[p.j], li, li, scale * p.f) * (1 + dj / di);
          slope += k_wall;
          power += k_wall * (s.temperature[i] - face.temperature);
        });
      // A prescribed flux enters the layer of particles next to the face.
      for (const WallFace& face : s.constants->faces)
        if (face.flux != 0 && std::abs(s.patch->x[face.axis][i] - face.plane) < s.constants->spacing)
          power += face.flux * layer;
      wall_slope_[i] = slope;
      wall_power_[i] = power;
    });
  });
}

/// Of heated particles. Dummies count as partners only where heat passes to them: any other face ends the
/// material like a free surface.
void ConductionOperator::find_missing_layers(const Stage& s) {
  missing_.assign(s.size(), 0.0);
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    with_kernel<D>(s.constants->kernel, [&](auto kernel) {
      using Kernel = decltype(kernel);
      const double* const volume = s.volume.data();
      const auto& pairs = *s.pairs;
      parallel_for(static_cast<std::ptrdiff_t>(s.heated.size()), [&](std::ptrdiff_t row) {
        const Index i = s.heated[row];
        if (surrounded(pairs, i, s.constants->lattice)) return;
        double sum = volume[i] * Kernel::w(0.0, 1 / s.patch->smoothing[i]);
        sum += pairs.template sum_row<D, 1>(
            i, [&](const sph::PairLanes<D>& p) { return std::array<sph::Lanes, 1>{p.of(volume) * p.w}; })[0];
        if (pairs.next_to_wall()[i])
          pairs.template for_row<D>(i, [&](const sph::Pair<D>& p) {
            if (s.patch->wall[p.j] && !s.constants->faces[s.patch->wall[p.j] - 1].isothermal)
              sum -= volume[p.j] * p.w;
          });
        missing_[i] = missing_layers(sum / s.constants->lattice.shepard, s.constants->lattice);
      });
    });
  });
}

double ConductionOperator::add_heating(const Stage& s, double* heating) const {
  const auto count = static_cast<std::ptrdiff_t>(s.heated.size());
  const double* const temperature = s.temperature.data();
  parallel_for(count, [&](std::ptrdiff_t row) {
    const Index i = s.heated[row];
    heating[i] += (exchange(*s.pairs, i, temperature) + wall_power_[i]) / s.patch->mass[i];
  });
  return parallel_sum(count, [&](std::ptrdiff_t row) { return wall_power_[s.heated[row]]; });
}

double ConductionOperator::rate(const Stage& s) const {
  const auto& material = s.constants->material;
  return parallel_max(static_cast<std::ptrdiff_t>(s.heated.size()), 0.0, [&](std::ptrdiff_t row) {
    const Index i = s.heated[row];
    return -(wall_slope_[i] + row_sum_[i]) / s.patch->mass[i] * material.temperature_slope(s.patch->h[i]);
  });
}

int ConductionOperator::solve(const Stage& s, double gamma, const double* local, const double* b, double* x,
                              double tolerance, int max_iterations) const {
  // In dT = (dT/dh) dh the matrix C - gamma K is symmetric positive definite (C = m dh/dT).
  const Index n = s.size();
  const auto count = static_cast<std::ptrdiff_t>(s.heated.size());
  capacity_.resize(n);
  dt_.assign(n, 0.0);
  vectors_.resize(n);
  const auto& pairs = *s.pairs;
  const auto& material = s.constants->material;
  const double* const mass = s.patch->mass.data();
  parallel_for(count, [&](std::ptrdiff_t row) {
    const Index i = s.heated[row];
    capacity_[i] = mass[i] / material.temperature_slope(s.patch->h[i]) -
                   gamma * (wall_slope_[i] + (local ? local[i] : 0.0));
    vectors_.inverse_diagonal[i] = 1 / (capacity_[i] - gamma * row_sum_[i]);
    vectors_.r[0][i] = mass[i] * b[i];
  });
  const auto report = solve::conjugate_gradient<1>(
      count, [&](std::ptrdiff_t row) { return s.heated[row]; },
      [&](Index i, const std::array<const double*, 1>& in) {
        return std::array<double, 1>{capacity_[i] * in[0][i] - gamma * exchange(pairs, i, in[0])};
      },
      vectors_, {dt_.data()}, tolerance, max_iterations);
  if (!report.converged) return -1;
  parallel_for(count, [&](std::ptrdiff_t row) {
    const Index i = s.heated[row];
    x[i] = dt_[i] / material.temperature_slope(s.patch->h[i]);
  });
  return report.iterations;
}

/// sum_j k_ij (T_i - T_j) [W].
double ConductionOperator::exchange(const sph::PairList& pairs, Index i, const double* temperature) const {
  const double ti = temperature[i];
  const Index* const j = pairs.neighbours();
  sph::Lanes sum = 0;
  for (Index q = pairs.begin(i); q < pairs.filled_end(i); q += sph::kLaneCount)
    sum += sph::load(k_.data() + q) * (ti - sph::gather(temperature, j + q));
  return sph::sum(sum);
}

}  // namespace meltray::terms
