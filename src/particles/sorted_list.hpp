// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "meltray/core/vec.hpp"

namespace meltray {

/// Lists of particles in ascending order. Throws std::logic_error where `i` is not in the list.
inline void erase_sorted(std::vector<Index>& list, Index i) {
  const auto it = std::lower_bound(list.begin(), list.end(), i);
  if (it == list.end() || *it != i) throw std::logic_error("a particle is not in the list it should leave");
  list.erase(it);
}

inline void insert_sorted(std::vector<Index>& list, Index i) {
  list.insert(std::lower_bound(list.begin(), list.end(), i), i);
}

}  // namespace meltray
