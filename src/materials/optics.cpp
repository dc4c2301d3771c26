// SPDX-License-Identifier: MIT
#include "meltray/materials/optics.hpp"

namespace meltray {

std::optional<std::complex<double>> hot_melt_index(std::string_view material) {
  if (material == "aluminium" || material == "al6061") return std::complex<double>{4.19, 9.73};
  return std::nullopt;
}

}  // namespace meltray
