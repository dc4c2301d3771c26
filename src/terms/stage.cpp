// SPDX-License-Identifier: MIT
#include "meltray/terms/stage.hpp"

#include <array>
#include <cmath>

#include "meltray/core/memory.hpp"

namespace meltray::terms {

namespace {

constexpr double kSurfaceFull = 0.86, kSurfaceNone = 0.94;    // Shepard sum
constexpr double kExposureFull = 0.60, kExposureNone = 0.35;  // colour gradient
/// Rows of a list that is made piece by piece.
constexpr Index kRowsOfPiece = 1024;

/// What the neighbours of a particle say of the surface; see Stage.
template <int D>
struct SurfaceRow {
  double fill = 1, diagonal = 1, exposure = 0, weight = 0, area = 0;
  std::array<double, D> gradient{}, normal{};
  bool loose = false;
};

template <int D, class Kernel>
SurfaceRow<D> surface_row(const Stage& s, const sph::PairList& pairs, Index i) {
  const auto& lattice = s.constants->lattice;
  const double* const volume = s.volume.data();
  const double site = s.area_of_spacing(), spacing = s.constants->spacing;
  SurfaceRow<D> row;
  const Index count = pairs.count(i);
  if (count == 0 && !s.patch->liquid[i]) return row;  // not a row: asleep or only a neighbour
  const auto sum = pairs.template sum_row<D, D + 2>(i, [&](const sph::PairLanes<D>& p) {
    const sph::Lanes v = p.of(volume), vf = v * p.f;
    std::array<sph::Lanes, D + 2> out;
    out[0] = v * p.w;
    out[1] = -vf;
    for (int c = 0; c < D; ++c) out[2 + c] = vf * p.x[c];
    return out;
  });
  const double self = volume[i] * Kernel::w(0.0, 1 / s.patch->smoothing[i]);
  row.fill = (sum[0] + self) / lattice.shepard;
  if (!s.constants->free_surface) return row;
  row.diagonal = sum[1] / lattice.laplacian;
  row.loose = s.patch->liquid[i] && count < fewest_neighbours(D);
  double norm = 0;
  for (int c = 0; c < D; ++c) {
    row.gradient[c] = sum[2 + c];
    norm += sum[2 + c] * sum[2 + c];
  }
  norm = std::sqrt(norm);
  row.exposure = std::min(1.0, 2 * norm * spacing / lattice.face_gradient);
  const double t = std::clamp(std::max((kSurfaceNone - row.fill) / (kSurfaceNone - kSurfaceFull),
                                       (row.exposure - kExposureNone) / (kExposureFull - kExposureNone)),
                              0.0, 1.0);
  // Dummies behind a face end where the box ends: that is not a free surface.
  row.weight = s.patch->wall[i] ? 0.0 : t * t * (3 - 2 * t);
  if (row.weight > 0 && norm > 0)
    for (int c = 0; c < D; ++c) row.normal[c] = -sum[2 + c] / norm;
  // The missing part of the kernel measures how much of a particle is open: a particle of a flat face
  // carries the area of one lattice site, one at an edge or in a drop more. The colour gradient alone
  // would not do: it vanishes by symmetry for a thin sheet or a lone particle, which then could not
  // cool.
  row.area = row.weight * site * std::max((1 - row.fill) / (1 - lattice.face_fill), row.exposure);
  return row;
}

/// Calls f(dimension, kernel) with both as types.
template <class F>
void with_kernel_of(const SceneConstants& constants, F&& f) {
  sph::with_dim(constants.dim,
                [&](auto d) { with_kernel<d>(constants.kernel, [&](auto kernel) { f(d, kernel); }); });
}

bool touches_melt(const Patch& patch, const sph::PairList& pairs, Index i) {
  for (Index k = pairs.begin(i); k < pairs.end(i); ++k)
    if (patch.liquid[pairs.neighbour(k)]) return true;
  return false;
}

}  // namespace

double Stage::area_of_spacing() const {
  return constants->dim == 2 ? constants->spacing : constants->spacing * constants->spacing;
}

std::size_t Stage::bytes() const {
  return held_bytes(volume, temperature, heat, lit, moving, heated, elastic, excess, fill, diagonal, exposure,
                    surface, area, face_temperature, surface_pressure, loose) +
         held_bytes(grad_c) + held_bytes(normal) + held_bytes(wall_normal);
}

void prepare_stage(Stage& s, bool with_surface) {
  const Index n = s.size();
  const Index of_surface = with_surface ? n : 0;  // compute_surface() sets all but the pressure
  for (auto* a : {&s.volume, &s.temperature}) a->resize(n);
  for (auto* a : {&s.fill, &s.diagonal, &s.exposure, &s.surface, &s.area}) a->resize(of_surface);
  for (int c = 0; c < s.constants->dim; ++c) {
    s.grad_c[c].resize(of_surface);
    s.normal[c].resize(of_surface);
  }
  s.surface_pressure.assign(of_surface, 0.0);
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

void release_fields(Stage& s) {
  free_memory(s.volume, s.temperature, s.excess, s.fill, s.diagonal, s.exposure, s.surface, s.area,
              s.face_temperature, s.surface_pressure, s.grad_c, s.normal, s.wall_normal);
}

void compute_surface(Stage& s) {
  with_kernel_of(*s.constants, [&](auto d, auto kernel) {
    parallel_for(s.size(), [&](Index i) {
      const SurfaceRow<d> row = surface_row<d, decltype(kernel)>(s, *s.pairs, i);
      s.fill[i] = row.fill;
      s.diagonal[i] = row.diagonal;
      s.exposure[i] = row.exposure;
      s.surface[i] = row.weight;
      s.area[i] = row.area;
      s.loose[i] = row.loose;
      for (int c = 0; c < d; ++c) {
        s.grad_c[c][i] = row.gradient[c];
        s.normal[c][i] = row.normal[c];
      }
    });
  });
}

void find_surface_weights(const Stage& s, const CellGrid& grid, std::vector<double>& weight) {
  const Patch& patch = *s.patch;
  weight.assign(s.size(), 0.0);
  sph::PairList piece;
  std::vector<Index> rows;
  for (std::span<const Index> left = patch.cells, cells; !left.empty(); left = left.subspan(cells.size())) {
    const Index begin = patch.cell_start[left.front()];
    std::size_t count = 1;
    while (count < left.size() && patch.cell_start[left[count] + 1] - begin <= kRowsOfPiece) ++count;
    cells = left.first(count);
    rows.clear();
    for (Index i = begin; i < patch.cell_start[cells.back() + 1]; ++i)
      if (!patch.wall[i]) rows.push_back(i);
    if (rows.empty()) continue;
    piece.build_piece(patch, grid, 0, cells);
    piece.refresh(patch, s.constants->kernel, rows);
    with_kernel_of(*s.constants, [&](auto d, auto kernel) {
      parallel_for(static_cast<std::ptrdiff_t>(rows.size()), [&](std::ptrdiff_t k) {
        const Index i = rows[k];
        if (patch.liquid[i] || touches_melt(patch, piece, i))
          weight[i] = surface_row<d, decltype(kernel)>(s, piece, i).weight;
      });
    });
  }
}

}  // namespace meltray::terms
