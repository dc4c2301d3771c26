// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/scene/scene.hpp"
#include "meltray/terms/elastic.hpp"

namespace meltray::scene {

/// True where the solid of a scene moves and takes stress instead of resting.
bool is_elastic(const Scene& scene);

/// The elastic solid of a scene, with its modulus scaled.
terms::ElasticSolid elastic_solid(const Scene& scene);

}  // namespace meltray::scene
