// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "meltray/core/vec.hpp"

/// Eight candidates of a neighbour search at a time, without a branch: nine of ten are too far away, and
/// which ones no processor can foretell. With AVX2 registers, else in plain loops with the same results.
namespace meltray::sph {

inline constexpr Index kCandidates = 8;

/// What the candidates of a row are compared with, in single precision, relative to the cell.
template <int D>
struct SearchedRow {
  float x[D], period[D], inverse_period[D];  ///< [m]; periods 0 in directions that have none
  float reach;     ///< of the row's own [m], to which that of the candidate is added
  float rounding;  ///< factor on that of the candidate
};

/// Bit l is set where candidate l is within reach. `x`, `h`: positions and smoothing lengths of eight [m].
template <int D, bool Periodic>
unsigned within_reach(const SearchedRow<D>& row, const std::array<const float*, 3>& x, const float* h) {
#ifdef __AVX2__
  __m256 r2 = _mm256_setzero_ps();
  for (int c = 0; c < D; ++c) {
    __m256 d = _mm256_sub_ps(_mm256_set1_ps(row.x[c]), _mm256_loadu_ps(x[c]));
    if constexpr (Periodic) {
      const __m256 images = _mm256_round_ps(_mm256_mul_ps(d, _mm256_set1_ps(row.inverse_period[c])),
                                            _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
      d = _mm256_fnmadd_ps(_mm256_set1_ps(row.period[c]), images, d);
    }
    r2 = _mm256_fmadd_ps(d, d, r2);
  }
  const __m256 reach =
      _mm256_fmadd_ps(_mm256_set1_ps(row.rounding), _mm256_loadu_ps(h), _mm256_set1_ps(row.reach));
  return static_cast<unsigned>(
      _mm256_movemask_ps(_mm256_cmp_ps(r2, _mm256_mul_ps(reach, reach), _CMP_LT_OQ)));
#else
  unsigned mask = 0;
  for (Index l = 0; l < kCandidates; ++l) {
    float r2 = 0;
    for (int c = 0; c < D; ++c) {
      float d = row.x[c] - x[c][l];
      if constexpr (Periodic) d -= row.period[c] * std::rint(d * row.inverse_period[c]);
      r2 += d * d;
    }
    const float reach = row.reach + row.rounding * h[l];
    mask |= static_cast<unsigned>(r2 < reach * reach) << l;
  }
  return mask;
#endif
}

#ifdef __AVX2__
/// Where the set bits of a byte stand, one after the other, then zeros.
inline constexpr auto kPlacesOfBits = [] {
  std::array<std::array<std::uint8_t, 8>, 256> places{};
  for (unsigned mask = 0; mask < 256; ++mask)
    for (unsigned bit = 0, n = 0; bit < 8; ++bit)
      if (mask >> bit & 1) places[mask][n++] = static_cast<std::uint8_t>(bit);
  return places;
}();
#endif

/// Writes those of eight indices whose bit is set and that are not `self`, one after the other, and returns
/// how many. All eight places of `out` may be written.
inline Index take_marked(const Index* index, unsigned mask, Index self, Index* out) {
  static_assert(sizeof(Index) == 4);
#ifdef __AVX2__
  const __m256i eight = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(index));
  const __m256i is_self = _mm256_cmpeq_epi32(eight, _mm256_set1_epi32(self));
  mask &= ~static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(is_self)));
  const __m128i places = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(kPlacesOfBits[mask].data()));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(out),
                      _mm256_permutevar8x32_epi32(eight, _mm256_cvtepu8_epi32(places)));
  return std::popcount(mask);
#else
  Index found = 0;
  for (; mask != 0; mask &= mask - 1) {
    const Index j = index[std::countr_zero(mask)];
    out[found] = j;
    found += j != self;
  }
  return found;
#endif
}

}  // namespace meltray::sph
