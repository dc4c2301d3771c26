// SPDX-License-Identifier: MIT
#include "meltray/terms/stage.hpp"

#include <cmath>

namespace meltray::terms {

namespace {

constexpr double kSurfaceFull = 0.86, kSurfaceNone = 0.94;    // Shepard sum
constexpr double kExposureFull = 0.60, kExposureNone = 0.35;  // colour gradient

}  // namespace

double Stage::area_of_spacing() const {
  return constants->dim == 2 ? constants->spacing : constants->spacing * constants->spacing;
}

void prepare_stage(Stage& s) {
  const Index n = s.size();
  for (auto* a : {&s.volume, &s.temperature}) a->resize(n);
  for (auto* a : {&s.fill, &s.diagonal, &s.exposure, &s.surface, &s.area, &s.surface_pressure})
    a->assign(n, 0.0);
  for (int c = 0; c < s.constants->dim; ++c) {
    s.grad_c[c].assign(n, 0.0);
    s.normal[c].assign(n, 0.0);
  }
  s.loose.assign(n, 0);
  s.moving.clear();
  s.heated.clear();
  s.elastic.clear();
  const bool elastic = !s.patch->elastic.empty();
  for (Index i = 0; i < n; ++i) {
    s.volume[i] = s.patch->mass[i] / (elastic ? s.patch->density[i] : s.constants->density);
    if (elastic && s.patch->elastic[i]) s.elastic.push_back(i);
    if (s.patch->liquid[i]) s.moving.push_back(i);
    if (s.heat[i]) s.heated.push_back(i);
  }
}

void compute_surface(Stage& s) {
  const auto& lattice = s.constants->lattice;
  const double* const volume = s.volume.data();
  const double site = s.area_of_spacing(), spacing = s.constants->spacing;
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    with_kernel<D>(s.constants->kernel, [&](auto kernel) {
      using Kernel = decltype(kernel);
      const auto& pairs = *s.pairs;
      parallel_for(s.size(), [&](Index i) {
        const Index count = pairs.end(i) - pairs.begin(i);
        s.loose[i] = 0;
        s.surface[i] = s.area[i] = s.exposure[i] = 0;
        for (int c = 0; c < D; ++c) s.normal[c][i] = s.grad_c[c][i] = 0;
        s.fill[i] = s.diagonal[i] = 1;
        if (count == 0 && !s.patch->liquid[i]) return;  // not a row: asleep or only a neighbour
        const auto sum = pairs.template sum_row<D, D + 2>(i, [&](const sph::Pair<D>& p) {
          const double vf = volume[p.j] * p.f;
          std::array<double, D + 2> out;
          out[0] = volume[p.j] * p.w;
          out[1] = -vf;
          for (int c = 0; c < D; ++c) out[2 + c] = vf * p.x[c];
          return out;
        });
        const double self = volume[i] * Kernel::w(0.0, 1 / s.patch->smoothing[i]);
        s.fill[i] = (sum[0] + self) / lattice.shepard;
        if (!s.constants->free_surface) return;
        s.diagonal[i] = sum[1] / lattice.laplacian;
        s.loose[i] = s.patch->liquid[i] && count < fewest_neighbours(D);
        double norm = 0;
        for (int c = 0; c < D; ++c) {
          s.grad_c[c][i] = sum[2 + c];
          norm += sum[2 + c] * sum[2 + c];
        }
        norm = std::sqrt(norm);
        s.exposure[i] = std::min(1.0, 2 * norm * spacing / lattice.face_gradient);
        const double t =
            std::clamp(std::max((kSurfaceNone - s.fill[i]) / (kSurfaceNone - kSurfaceFull),
                                (s.exposure[i] - kExposureNone) / (kExposureFull - kExposureNone)),
                       0.0, 1.0);
        // Dummies behind a face end where the box ends: that is not a free surface.
        s.surface[i] = s.patch->wall[i] ? 0.0 : t * t * (3 - 2 * t);
        if (s.surface[i] > 0 && norm > 0)
          for (int c = 0; c < D; ++c) s.normal[c][i] = -sum[2 + c] / norm;
        // The missing part of the kernel measures how much of a particle is open: a particle of a flat face
        // carries the area of one lattice site, one at an edge or in a drop more. The colour gradient alone
        // would not do: it vanishes by symmetry for a thin sheet or a lone particle, which then could not
        // cool.
        s.area[i] = s.surface[i] * site * std::max((1 - s.fill[i]) / (1 - lattice.face_fill), s.exposure[i]);
      });
    });
  });
}

}  // namespace meltray::terms
