// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <experimental/simd>

#include "meltray/core/vec.hpp"

/// Loops over several neighbours at a time. Compilers turn an indexed load in a plain loop into vector
/// arithmetic on addresses, which costs more than the load; written with registers, the indices stay ordinary
/// integers.
namespace meltray::sph {

/// As many doubles as a register of the program's instruction set holds.
using Lanes = std::experimental::native_simd<double>;
inline constexpr Index kLaneCount = static_cast<Index>(Lanes::size());

/// field[j[0]], field[j[1]], ...
template <class T>
Lanes gather(const T* field, const Index* j) {
  return Lanes([&](auto lane) { return static_cast<double>(field[j[lane]]); });
}

/// Values that follow one another, in single or double precision.
template <class T>
Lanes load(const T* p) {
  using Stored = std::experimental::rebind_simd_t<T, Lanes>;
  return std::experimental::static_simd_cast<Lanes>(Stored(p, std::experimental::element_aligned));
}

template <class T>
void store(T* p, const Lanes& lanes) {
  using Stored = std::experimental::rebind_simd_t<T, Lanes>;
  std::experimental::static_simd_cast<Stored>(lanes).copy_to(p, std::experimental::element_aligned);
}

inline double sum(const Lanes& lanes) {
  return std::experimental::reduce(lanes);
}

}  // namespace meltray::sph
