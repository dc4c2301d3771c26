// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/scene/scene.hpp"
#include "scene/case_document.hpp"

namespace meltray::scene {

/// What no single key can tell: contradictions between keys, and combinations in which a setting does
/// nothing. Throw UsageError at the key that is to change.
void check_geometry(const Scene& scene, const Document& document);
void check_material(const Scene& scene, const Document& document);
void check_terms(const Scene& scene, const Document& document);
void check_elastic(const Scene& scene, const Document& document);
void check_flow(const Scene& scene, const Document& document);
void check_laser(const Scene& scene, const Document& document);
void check_time(const Scene& scene, const Document& document);

}  // namespace meltray::scene
