// SPDX-License-Identifier: MIT
#include "meltray/terms/conduction.hpp"

#include <cmath>

namespace meltray::terms {

void ConductionOperator::assemble(const Stage& s) {
  assembled_ = true;
  const Index n = s.size();
  const auto& pairs = *s.pairs;
  conductivity_.resize(n);
  k_.resize(pairs.pairs());
  wall_slope_.assign(n, 0.0);
  wall_power_.assign(n, 0.0);
  parallel_for(n, [&](Index i) {
    conductivity_[i] = s.heat[i] ? s.constants->material.conductivity(s.patch->h[i]) : 0.0;
  });
  const double scale = 1 / s.constants->lattice.second_moment;
  const double half = 0.5 * s.constants->spacing;
  const double layer = s.area_of_spacing();
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    const double* const volume = s.volume.data();
    const double* const lambda = conductivity_.data();
    parallel_for(static_cast<std::ptrdiff_t>(s.heated.size()), [&](std::ptrdiff_t row) {
      const Index i = s.heated[row];
      const double vi = 4 * scale * volume[i], li = lambda[i];
      double* const k = k_.data();
      // A partner outside the state has conductivity 0 here, so that the pair exchanges nothing.
      pairs.for_row_simd<D>(i, [&](const sph::Pair<D>& p) {
        const double lj = lambda[p.j];
        k[p.k] = vi * volume[p.j] * li * lj / (li + lj) * p.f;
      });
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

double ConductionOperator::add_heating(const Stage& s, double* heating) const {
  const auto count = static_cast<std::ptrdiff_t>(s.heated.size());
  const double* const temperature = s.temperature.data();
  const double* const k = k_.data();
  const Index* const neighbour = s.pairs->neighbours();
  parallel_for(count, [&](std::ptrdiff_t row) {
    const Index i = s.heated[row];
    const double ti = temperature[i];
    double sum = 0;
    const Index last = s.pairs->end(i);
#pragma omp simd reduction(+ : sum)
    for (Index q = s.pairs->begin(i); q < last; ++q) sum += k[q] * (ti - temperature[neighbour[q]]);
    heating[i] += (sum + wall_power_[i]) / s.patch->mass[i];
  });
  return parallel_sum(count, [&](std::ptrdiff_t row) { return wall_power_[s.heated[row]]; });
}

double ConductionOperator::rate(const Stage& s) const {
  const auto& material = s.constants->material;
  return parallel_max(static_cast<std::ptrdiff_t>(s.heated.size()), 0.0, [&](std::ptrdiff_t row) {
    const Index i = s.heated[row];
    double sum = -wall_slope_[i];
    for (Index q = s.pairs->begin(i); q < s.pairs->end(i); ++q) sum -= k_[q];
    return sum / s.patch->mass[i] * material.temperature_slope(s.patch->h[i]);
  });
}

int ConductionOperator::solve(const Stage& s, double gamma, const double* local, const double* b, double* x,
                              double tolerance, int max_iterations) const {
  // In dT = (dT/dh) dh the matrix C - gamma K is symmetric positive definite (C = m dh/dT).
  const Index n = s.size();
  const auto count = static_cast<std::ptrdiff_t>(s.heated.size());
  for (auto* a : {&r_, &ap_, &inverse_diagonal_, &capacity_}) a->resize(n);
  p_.assign(n, 0.0);
  dt_.assign(n, 0.0);
  const auto& pairs = *s.pairs;
  const auto& material = s.constants->material;
  const double* const mass = s.patch->mass.data();
  parallel_for(count, [&](std::ptrdiff_t row) {
    const Index i = s.heated[row];
    double off = 0;
    for (Index q = pairs.begin(i); q < pairs.end(i); ++q) off += k_[q];
    capacity_[i] = mass[i] / material.temperature_slope(s.patch->h[i]) -
                   gamma * (wall_slope_[i] + (local ? local[i] : 0.0));
    inverse_diagonal_[i] = 1 / (capacity_[i] - gamma * off);
    r_[i] = mass[i] * b[i];
    p_[i] = inverse_diagonal_[i] * r_[i];
  });
  const double* const k = k_.data();
  const Index* const neighbour = pairs.neighbours();
  const auto apply = [&](const std::vector<double>& values, std::vector<double>& out) {
    const double* const in = values.data();
    parallel_for(count, [&](std::ptrdiff_t row) {
      const Index i = s.heated[row];
      const double ti = in[i];
      double sum = 0;
      const Index last = pairs.end(i);
#pragma omp simd reduction(+ : sum)
      for (Index q = pairs.begin(i); q < last; ++q) sum += k[q] * (ti - in[neighbour[q]]);
      out[i] = capacity_[i] * ti - gamma * sum;
    });
  };
  const auto dot = [&](const std::vector<double>& a, const std::vector<double>& c) {
    return parallel_sum(count, [&](std::ptrdiff_t row) { return a[s.heated[row]] * c[s.heated[row]]; });
  };
  const auto preconditioned = [&] {
    return parallel_sum(count, [&](std::ptrdiff_t row) {
      const Index i = s.heated[row];
      return r_[i] * r_[i] * inverse_diagonal_[i];
    });
  };
  double rz = preconditioned();
  const double target = tolerance * tolerance * rz;
  int iteration = 0;
  for (; rz > target && rz > 0; ++iteration) {
    if (iteration == max_iterations) return -1;
    apply(p_, ap_);
    const double alpha = rz / dot(p_, ap_);
    parallel_for(count, [&](std::ptrdiff_t row) {
      const Index i = s.heated[row];
      dt_[i] += alpha * p_[i];
      r_[i] -= alpha * ap_[i];
    });
    const double next = preconditioned();
    const double beta = next / rz;
    rz = next;
    parallel_for(count, [&](std::ptrdiff_t row) {
      const Index i = s.heated[row];
      p_[i] = inverse_diagonal_[i] * r_[i] + beta * p_[i];
    });
  }
  parallel_for(count, [&](std::ptrdiff_t row) {
    const Index i = s.heated[row];
    x[i] = dt_[i] / material.temperature_slope(s.patch->h[i]);
  });
  return iteration;
}

}  // namespace meltray::terms
