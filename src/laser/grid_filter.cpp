// SPDX-License-Identifier: MIT
#include "laser/grid_filter.hpp"

#include <algorithm>

#include "meltray/core/parallel.hpp"

namespace meltray::laser {
namespace {

/// out = in filtered along y or z: a row of nodes is a sum of whole rows.
void across(const float* in, const Nodes& n, std::size_t axis, const std::vector<float>& taps, float* out) {
  const std::ptrdiff_t stride = axis == 1 ? n[0] : n[0] * n[1], last = n[axis] - 1;
  parallel_for(n[1] * n[2], [&](std::ptrdiff_t row) {
    const std::ptrdiff_t at = axis == 1 ? row % n[1] : row / n[1];
    const float* centre = in + row * n[0];
    float* sum = out + row * n[0];
    for (std::ptrdiff_t i = 0; i < n[0]; ++i) sum[i] = taps[0] * centre[i];
    for (std::size_t d = 1; d < taps.size(); ++d) {
      const auto reach = static_cast<std::ptrdiff_t>(d);
      const float* below = centre - std::min(reach, at) * stride;
      const float* above = centre + std::min(reach, last - at) * stride;
      const float tap = taps[d];
      for (std::ptrdiff_t i = 0; i < n[0]; ++i) sum[i] += tap * (below[i] + above[i]);
    }
  });
}

/// Filters along x in place.
void along(float* values, const Nodes& n, const std::vector<float>& taps) {
  const std::size_t width = static_cast<std::size_t>(n[0]), reach = taps.size() - 1;
  parallel_for(n[1] * n[2], [&](std::ptrdiff_t row) {
    thread_local std::vector<float> line;
    line.resize(width + 2 * reach);
    float* sum = values + row * n[0];
    std::fill_n(line.begin(), reach, sum[0]);
    std::copy_n(sum, width, line.data() + reach);
    std::fill_n(line.data() + reach + width, reach, sum[width - 1]);
    const float* centre = line.data() + reach;
    for (std::size_t i = 0; i < width; ++i) sum[i] *= taps[0];
    for (std::size_t d = 1; d <= reach; ++d) {
      const float *left = centre - d, *right = centre + d, tap = taps[d];
      for (std::size_t i = 0; i < width; ++i) sum[i] += tap * (left[i] + right[i]);
    }
  });
}

}  // namespace

void filter(std::vector<float>& values, const Nodes& nodes, const std::vector<float>& taps) {
  // Kept: to get and clear it anew each time costs more than a pass.
  thread_local std::vector<float> scratch;
  scratch.resize(values.size());
  along(values.data(), nodes, taps);
  across(values.data(), nodes, 1, taps, scratch.data());
  across(scratch.data(), nodes, 2, taps, values.data());
}

std::vector<float> binomial(int n) {
  // Pascal's row of 2n, from its middle outwards.
  std::vector<float> taps(static_cast<std::size_t>(n) + 1);
  double share = 1;
  for (int k = 1; k <= n; ++k) share *= (2.0 * k - 1) / (2.0 * k);
  for (int d = 0; d <= n; ++d) {
    taps[static_cast<std::size_t>(d)] = static_cast<float>(share);
    share *= static_cast<double>(n - d) / (n + d + 1);
  }
  return taps;
}

}  // namespace meltray::laser
