// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <optional>
#include <string_view>

namespace meltray {

/// Refractive index n + ik of a built-in material far above its melting point, near 1.07 um, where that is
/// known to differ from the one just above it; nothing otherwise. Aluminium: free-electron metal of 3
/// electrons an atom and 0.41 uOhm m, assumed for about 2700 K.
std::optional<std::complex<double>> hot_melt_index(std::string_view material);

}  // namespace meltray
