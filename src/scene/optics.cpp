// SPDX-License-Identifier: MIT
#include "meltray/scene/optics.hpp"

#include "meltray/materials/optics.hpp"

namespace meltray::scene {

LaserIndex laser_index(const Scene& scene) {
  const Material& m = scene.material;
  LaserIndex index{m.index_solid, m.index_liquid};
  if (!scene.laser) return index;
  if (scene.laser->optics == Optics::solid) index.liquid = index.solid;
  if (scene.laser->optics == Optics::hot_melt) index.liquid = hot_melt_index(m.name).value_or(m.index_liquid);
  return index;
}

std::string_view name_of(Optics optics) {
  switch (optics) {
    case Optics::by_phase:
      return "by_phase";
    case Optics::solid:
      return "solid";
    case Optics::hot_melt:
      return "hot_melt";
  }
  return "";
}

}  // namespace meltray::scene
