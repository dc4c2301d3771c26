// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "meltray/scene/scene.hpp"

namespace meltray::app {

/// Settings that are allowed and hardly meant, most of them of welds: one sentence each; empty for most
/// scenes.
std::vector<std::string> doubtful_settings(const scene::Scene& scene);

}  // namespace meltray::app
