// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/scene/scene.hpp"

namespace meltray::scene {

/// A mistyped spacing must not take all memory of the machine before anything is said. Throws UsageError
/// where the particles of a scene at rest, with a checkpoint of them, are more than the machine has memory
/// for.
void refuse_more_than_memory_holds(const Scene& scene);

}  // namespace meltray::scene
