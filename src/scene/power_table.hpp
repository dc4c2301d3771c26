// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scene/case_document.hpp"

namespace meltray::scene {

/// Laser power over time [(s, W)] from a CSV file "time_s,power_w" or an array of pairs. Times rise strictly.
/// Throws Refusal; `allowed` is for its message.
std::vector<std::pair<double, double>> read_power_table(const Entry& entry, const std::string& allowed);

}  // namespace meltray::scene
