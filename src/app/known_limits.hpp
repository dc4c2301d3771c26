// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "meltray/scene/scene.hpp"

namespace meltray::app {

/// Where a scene goes beyond what validation/studies/README.md found stable: one sentence each with what was
/// found and what would do; empty for most.
std::vector<std::string> beyond_known_limits(const scene::Scene& scene);

}  // namespace meltray::app
