// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>

#include "meltray/terms/stage.hpp"

namespace meltray::terms {

/// What bounds the melt at a particle: its colour there (sum of V W over that of a full lattice) and the unit
/// vector into it, along the colour's gradient. Colour 0 where there is none.
template <int D>
struct SolidBeside {
  double colour = 0;
  std::array<double, D> into{};
};

/// `volume_of(pairs)` gives the volumes of the neighbours that count, 0 for the others.
template <int D, class F>
SolidBeside<D> solid_beside(const Stage& s, Index i, F&& volume_of) {
  const auto sum = s.pairs->sum_row<D, D + 1>(i, [&](const sph::PairLanes<D>& p) {
    const sph::Lanes v = volume_of(p);
    std::array<sph::Lanes, D + 1> out;
    out[0] = v * p.w;
    for (int c = 0; c < D; ++c) out[1 + c] = v * p.f * p.x[c];
    return out;
  });
  double norm = 0;
  for (int c = 0; c < D; ++c) norm += sum[1 + c] * sum[1 + c];
  if (norm == 0) return {};
  norm = std::sqrt(norm);
  SolidBeside<D> solid{sum[0] / s.constants->lattice.shepard, {}};
  for (int c = 0; c < D; ++c) solid.into[c] = sum[1 + c] / norm;
  return solid;
}

}  // namespace meltray::terms
