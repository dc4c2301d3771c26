// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace meltray::app {

/// null for what is not there and for what JSON has no number for.
inline nlohmann::json json_number(const std::optional<double>& number) {
  if (!number || !std::isfinite(*number)) return nullptr;
  return *number;
}

}  // namespace meltray::app
