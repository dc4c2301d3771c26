// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>

namespace meltray::integration {

/// Entries handled by one thread in one go; below a few of them one thread is faster.
inline constexpr std::ptrdiff_t kSweepBlock = 4096;
inline constexpr std::ptrdiff_t kSweepSerialBelow = 4 * kSweepBlock;

/// Calls block(begin, end) over [0, n), in parallel where n is large. The blocks do not depend on the number
/// of threads.
template <class Block>
void sweep_blocks(std::size_t n, Block&& block) {
  const auto size = static_cast<std::ptrdiff_t>(n);
  if (size < kSweepSerialBelow) {
    for (std::ptrdiff_t b = 0; b < size; b += kSweepBlock) block(b, std::min(size, b + kSweepBlock));
    return;
  }
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t b = 0; b < size; b += kSweepBlock) block(b, std::min(size, b + kSweepBlock));
}

/// Calls f(i) over [0, n) with vector instructions; f touches only entry i of its arrays.
template <class F>
void sweep(std::size_t n, F&& f) {
  sweep_blocks(n, [&f](std::ptrdiff_t begin, std::ptrdiff_t end) {
#pragma omp simd
    for (std::ptrdiff_t i = begin; i < end; ++i) f(i);
  });
}

}  // namespace meltray::integration
