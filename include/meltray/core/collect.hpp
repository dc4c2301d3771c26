// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace meltray {

/// Calls f(i, found) for i in [0, n), which appends what it finds to `found`; afterwards `out` holds all of
/// it in the order of i. Blocks of `block` consecutive i run side by side.
template <class T, class F>
void parallel_collect(std::ptrdiff_t n, std::ptrdiff_t block, std::vector<T>& out, F&& f) {
  const std::ptrdiff_t blocks = (n + block - 1) / block;
  thread_local std::vector<std::vector<T>> parts;  // kept, so that they need no new memory each time
  if (static_cast<std::ptrdiff_t>(parts.size()) < blocks) parts.resize(static_cast<std::size_t>(blocks));
  std::vector<T>* part = parts.data();
#pragma omp parallel for schedule(dynamic, 1) if (blocks > 1)
  for (std::ptrdiff_t b = 0; b < blocks; ++b) {
    part[b].clear();
    for (std::ptrdiff_t i = b * block; i < std::min(n, (b + 1) * block); ++i) f(i, part[b]);
  }
  std::size_t total = 0;
  for (std::ptrdiff_t b = 0; b < blocks; ++b) total += part[b].size();
  out.clear();
  out.reserve(total);
  for (std::ptrdiff_t b = 0; b < blocks; ++b) out.insert(out.end(), part[b].begin(), part[b].end());
}

}  // namespace meltray
