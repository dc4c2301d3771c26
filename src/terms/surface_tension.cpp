// SPDX-License-Identifier: MIT
#include <cmath>

#include "meltray/terms/surface_forces.hpp"

namespace meltray::terms {

namespace {

/// Share of a flat layer's sum of W t^2 (t the distance in the tangent plane) that a particle with fewer
/// neighbours beside it is taken to have. A particle with one at its own spacing has more; one with a
/// neighbour behind it only would bend without bounds as t goes to 0 (4e4 times the curvature of its drop
/// were seen at a torn rim), though two particles have no curvature.
constexpr double kLeastSpread = 0.2;

template <int D>
void normalise(std::array<double, D>& v) {
  double norm = 0;
  for (int c = 0; c < D; ++c) norm += v[c] * v[c];
  norm = std::sqrt(norm);
  for (int c = 0; c < D; ++c) v[c] = norm > 0 ? v[c] / norm : 0.0;
}

/// Turns n towards the normal that the wall prescribes, by its share.
template <int D>
void hold(const Components& wall_normal, Index i, std::array<double, D>& n) {
  double share = 0;
  for (int c = 0; c < D; ++c) share += wall_normal[c][i] * wall_normal[c][i];
  if (share == 0) return;
  share = std::sqrt(share);
  for (int c = 0; c < D; ++c) n[c] = (1 - share) * n[c] + wall_normal[c][i];
  normalise<D>(n);
}

}  // namespace

double SurfaceTension::activation(const Stage& s, Index i) const {
  if (!s.patch->liquid[i] || s.loose[i]) return 0;
  if (ramp <= 0) return 1;
  return std::clamp((s.temperature[i] - s.constants->melting_temperature()) / ramp, 0.0, 1.0);
}

/// Normals averaged over surface neighbours, twice: those of single particles follow the steps of the
/// lattice, and a curvature taken from them comes out up to 1.8 times too large on a ball of 20 particles'
/// radius. Only melt takes part, here and below: the face of dry solid beside a line of contact is no part of
/// the surface that pulls, and would read as a sharp corner of it. Where a wall prescribes the normal it is
/// held: averaged with those above the wall only, it would lose half of its turn, and with it half of the
/// force that moves the line of contact.
void SurfaceTension::smooth_normals(const Stage& s) const {
  constexpr int kPasses = 2;
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    with_kernel<D>(s.constants->kernel, [&](auto kernel) {
      using Kernel = decltype(kernel);
      const double* const surface = s.surface.data();
      const std::uint8_t* const melt = s.patch->liquid.data();
      const bool held = !s.wall_normal[0].empty();
      smooth_ = s.normal;
      for (int pass = 0; pass < kPasses; ++pass) {
        previous_ = smooth_;
        const ConstField n = view(static_cast<const Components&>(previous_));
        parallel_for(s.size(), [&](Index i) {
          if (surface[i] == 0 || s.loose[i] || !melt[i]) return;
          auto sum = s.pairs->template sum_row<D, D>(i, [&](const sph::PairLanes<D>& p) {
            const sph::Lanes weight = p.of(surface) * p.of(melt) * p.w;
            std::array<sph::Lanes, D> out;
            for (int c = 0; c < D; ++c) out[c] = weight * p.of(n[c]);
            return out;
          });
          const double self = surface[i] * Kernel::w(0.0, 1 / s.patch->smoothing[i]);
          for (int c = 0; c < D; ++c) sum[c] += self * n[c][i];
          normalise<D>(sum);
          if (held) hold<D>(s.wall_normal, i, sum);
          for (int c = 0; c < D; ++c) smooth_[c][i] = sum[c];
        });
      }
    });
  });
}

void SurfaceTension::pressure(const Stage& s, std::vector<double>& out) const {
  out.resize(s.size());
  smooth_normals(s);
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    const ConstField n = view(static_cast<const Components&>(smooth_));
    const double* const surface = s.surface.data();
    const std::uint8_t* const melt = s.patch->liquid.data();
    const double least = kLeastSpread * s.constants->lattice.layer_spread / std::pow(s.constants->spacing, D);
    parallel_for(s.size(), [&](Index i) {
      out[i] = 0;
      const double active = s.surface[i] > 0 ? activation(s, i) : 0.0;
      if (active == 0) return;
      double ni[D];
      for (int c = 0; c < D; ++c) ni[c] = n[c][i];
      const auto sum = s.pairs->sum_row<D, 2>(i, [&](const sph::PairLanes<D>& p) {
        sph::Lanes along = 0, bend = 0, t2 = 0;
        for (int c = 0; c < D; ++c) along += p.x[c] * ni[c];
        for (int c = 0; c < D; ++c) {
          const sph::Lanes t = along * ni[c] - p.x[c];  // offset x_j - x_i in the tangent plane
          bend += (p.of(n[c]) - ni[c]) * t;
          t2 += t * t;
        }
        const sph::Lanes weight = p.of(surface) * p.of(melt) * p.w;
        return std::array<sph::Lanes, 2>{weight * bend, weight * t2};
      });
      const double kappa = (D - 1) * sum[0] / std::max(sum[1], least);
      out[i] = active * s.constants->material.sigma(s.temperature[i]) * kappa;
    });
  });
}

void average_over_surface(const Stage& s, const std::vector<double>& pressure, std::vector<double>& average) {
  average.resize(s.size());
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    with_kernel<D>(s.constants->kernel, [&](auto kernel) {
      using Kernel = decltype(kernel);
      const double* const surface = s.surface.data();
      const double* const p = pressure.data();
      const std::uint8_t* const melt = s.patch->liquid.data();
      parallel_for(s.size(), [&](Index i) {
        average[i] = 0;
        const bool inside = s.surface[i] == 0 && s.fill[i] >= 1;
        if (inside || s.loose[i] || s.pairs->count(i) == 0) return;
        const auto sum = s.pairs->sum_row<D, 2>(i, [&](const sph::PairLanes<D>& q) {
          const sph::Lanes weight = q.of(surface) * q.of(melt) * q.w;
          return std::array<sph::Lanes, 2>{weight * q.of(p), weight};
        });
        const double self = melt[i] ? surface[i] * Kernel::w(0.0, 1 / s.patch->smoothing[i]) : 0.0;
        const double weight = sum[1] + self;
        if (weight > 0) average[i] = (sum[0] + self * p[i]) / weight;
      });
    });
  });
}

}  // namespace meltray::terms
