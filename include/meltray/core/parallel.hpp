// SPDX-License-Identifier: MIT
#pragma once

#include <omp.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace meltray {

/// Number of threads of every parallel loop (set once at start; results do not depend on it).
inline void set_threads(int n) {
  omp_set_num_threads(n);
}
inline int threads() {
  return omp_get_max_threads();
}

/// Below this many items a parallel region costs more than it gains.
inline constexpr std::ptrdiff_t kSerialBelow = 512;

/// Calls f(i) for i in [0, n). f writes only to places owned by i, so the result is the same with any number
/// of threads. A thread takes consecutive items, the same in every loop, so that what it wrote is still in
/// its own cache when it reads it.
template <class F>
void parallel_for(std::ptrdiff_t n, F&& f) {
  if (n < kSerialBelow) {
    for (std::ptrdiff_t i = 0; i < n; ++i) f(i);
    return;
  }
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < n; ++i) f(i);
}

/// The same where the cost of an item depends on its place, as rows of a patch do: many for melt, none for
/// what rests. Threads take turns.
template <class F>
void parallel_for_uneven(std::ptrdiff_t n, F&& f) {
  if (n < kSerialBelow) {
    for (std::ptrdiff_t i = 0; i < n; ++i) f(i);
    return;
  }
#pragma omp parallel for schedule(static, 64)
  for (std::ptrdiff_t i = 0; i < n; ++i) f(i);
}

/// n zeros in a field, set by the threads that will add to them.
inline void clear(std::vector<double>& field, std::ptrdiff_t n) {
  field.resize(static_cast<std::size_t>(n));
  double* const f = field.data();
  parallel_for(n, [=](std::ptrdiff_t i) { f[i] = 0; });
}

/// Reductions run over fixed blocks of items that are combined in order: bitwise independent of the number of
/// threads. Below `serial_below` items waking the other threads costs more than it gains.
struct Blocks {
  std::ptrdiff_t size, serial_below;
};
/// For bodies of a few operations, and for those as heavy as a row of a matrix.
inline constexpr Blocks kLight{1024, 8 * 1024}, kRows{64, kSerialBelow};

/// Reduces block results `block(begin, end)` with `combine(total, part)` in fixed order.
template <class T, class Block, class Combine>
T parallel_reduce(std::ptrdiff_t n, T init, Block&& block, Combine&& combine, Blocks blocks = kLight) {
  const std::ptrdiff_t count = (n + blocks.size - 1) / blocks.size;
  if (count <= 1) return n > 0 ? combine(init, block(std::ptrdiff_t{0}, n)) : init;
  thread_local std::vector<T> parts;
  parts.assign(static_cast<std::size_t>(count), init);
  T* part = parts.data();
#pragma omp parallel for schedule(static) if (n >= blocks.serial_below)
  for (std::ptrdiff_t b = 0; b < count; ++b)
    part[b] = block(b * blocks.size, std::min(n, (b + 1) * blocks.size));
  T total = init;
  for (std::ptrdiff_t b = 0; b < count; ++b) total = combine(total, part[b]);
  return total;
}

/// Sum of f(i) over [0, n).
template <class F>
double parallel_sum(std::ptrdiff_t n, F&& f) {
  return parallel_reduce(
      n, 0.0,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        double s = 0;
#pragma omp simd reduction(+ : s)
        for (std::ptrdiff_t i = begin; i < end; ++i) s += f(i);
        return s;
      },
      [](double a, double b) { return a + b; });
}

/// Sum of f(i) over [0, n) for bodies as heavy as a row of a matrix: shared among threads from few items on.
template <class F>
double parallel_sum_rows(std::ptrdiff_t n, F&& f) {
  return parallel_reduce(
      n, 0.0,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        double s = 0;
        for (std::ptrdiff_t i = begin; i < end; ++i) s += f(i);
        return s;
      },
      [](double a, double b) { return a + b; }, kRows);
}

/// Largest f(i) over [0, n), or `floor` where that is larger.
template <class F>
double parallel_max(std::ptrdiff_t n, double floor, F&& f) {
  return parallel_reduce(
      n, floor,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        double m = floor;
        for (std::ptrdiff_t i = begin; i < end; ++i) m = std::max(m, f(i));
        return m;
      },
      [](double a, double b) { return std::max(a, b); });
}

}  // namespace meltray
