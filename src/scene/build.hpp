// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/particles/cell_grid.hpp"
#include "meltray/particles/particles.hpp"
#include "meltray/scene/scene.hpp"
#include "meltray/terms/stage.hpp"

namespace meltray::scene {

/// Constants of the terms from a scene.
terms::SceneConstants build_constants(const Scene& scene);
/// Particles of the bodies on their lattice and dummies behind wall faces. Throws UsageError for an empty
/// scene.
Particles build_particles(const Scene& scene, const terms::SceneConstants& constants);
/// Cells one support radius (plus the list's skin) wide over the box and its dummies.
CellGrid build_grid(const Scene& scene, const terms::SceneConstants& constants, double skin);

}  // namespace meltray::scene
