// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

namespace meltray {

/// Resizes a large array whose content is not needed. resize() would double what is held whenever a little
/// more is asked for, and copy; here it is a sixteenth, and the old memory is given back before.
template <class Vector>
void resize_anew(Vector& v, std::size_t n) {
  if (n > v.capacity()) {
    v = Vector();
    v.reserve(n + n / 16);
  }
  v.resize(n);
}

/// Gives the memory of arrays back. `v = {}` would keep it: that assigns an empty list of entries.
template <class... Vectors>
void free_memory(Vectors&... v) {
  ((v = Vectors()), ...);
}

/// Bytes that arrays hold, also those not in use.
template <class... Vectors>
std::size_t held_bytes(const Vectors&... v) {
  return (std::size_t{0} + ... + (v.capacity() * sizeof(typename Vectors::value_type)));
}
/// The same of components of a field.
template <class Vector, std::size_t N>
std::size_t held_bytes(const std::array<Vector, N>& components) {
  std::size_t n = 0;
  for (const Vector& v : components) n += held_bytes(v);
  return n;
}

}  // namespace meltray
