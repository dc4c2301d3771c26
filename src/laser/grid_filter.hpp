// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace meltray::laser {

/// Numbers of nodes of a regular grid along x, y and z; x runs fastest.
using Nodes = std::array<std::ptrdiff_t, 3>;

/// Convolves node values along every axis with the symmetric weights taps[0] (centre), taps[1] (both
/// neighbours) and so on. Beyond its ends the grid is continued by its last values.
void filter(std::vector<float>& values, const Nodes& nodes, const std::vector<float>& taps);

/// Weights of (1/4, 1/2, 1/4) applied n times: variance n/2 steps squared.
std::vector<float> binomial(int n);

}  // namespace meltray::laser
