// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <utility>

#include "meltray/scene/elastic.hpp"
#include "scene/case_check.hpp"

namespace meltray::scene {

namespace {

/// A custom material has no defaults: what the active terms use has to be given.
void check_custom(const Scene& scene, const Document& document) {
  const Terms& t = scene.terms;
  const bool thermal = t.conduction || t.evaporation || t.radiation || t.melting || scene.laser.has_value();
  const bool elastic = is_elastic(scene);
  const bool vapour = t.evaporation || (t.recoil && scene.surface.recoil_pressure == 0);
  const bool fresnel = scene.laser && !scene.laser->trace.fixed_absorptance;
  struct Use {
    const char* name;
    bool used;
  };
  const std::array<Use, 24> uses = {{{"density_kg_m3", true},
                                     {"heat_capacity_solid_j_kg_k", true},
                                     {"heat_capacity_liquid_j_kg_k", true},
                                     {"solidus_k", true},
                                     {"liquidus_k", true},
                                     {"latent_heat_fusion_j_kg", thermal},
                                     {"conductivity_solid_w_m_k", t.conduction},
                                     {"conductivity_liquid_w_m_k", t.conduction},
                                     {"boiling_temperature_k", vapour},
                                     {"latent_heat_vaporisation_j_kg", vapour},
                                     {"molar_mass_kg_mol", vapour},
                                     {"viscosity_pa_s", t.viscosity},
                                     {"surface_tension_n_m", t.surface_tension || t.marangoni},
                                     {"expansion_1_k", t.buoyancy},
                                     {"expansion_reference_k", t.buoyancy},
                                     {"linear_expansion_solid_1_k", elastic && scene.flow.thermal_expansion},
                                     {"youngs_modulus_pa", elastic},
                                     {"poisson_ratio", elastic},
                                     {"emissivity", t.radiation},
                                     {"contact_angle_deg", t.wetting},
                                     {"refractive_n_solid", fresnel},
                                     {"refractive_k_solid", fresnel},
                                     {"refractive_n_liquid", fresnel},
                                     {"refractive_k_liquid", fresnel}}};
  for (const Use& use : uses) {
    const std::string key = std::string("material.") + use.name;
    if (use.used && !document.given(key))
      refuse(document.place("material.name"), key, "nothing, with material.name = \"custom\"",
             "a value: this scene uses the property");
  }
}

}  // namespace

void check_material(const Scene& scene, const Document& document) {
  const Material& m = scene.material;
  if (m.name == "custom") check_custom(scene, document);
  if (!(m.solidus < m.liquidus)) {
    const char* key = document.given("material.solidus_k") ? "material.solidus_k" : "material.liquidus_k";
    refuse(document.place(key), key, fmt::format("solidus {} K, liquidus {} K", m.solidus, m.liquidus),
           "solidus_k < liquidus_k");
  }
  const bool vapour = scene.terms.evaporation || (scene.terms.recoil && scene.surface.recoil_pressure == 0);
  for (const auto& [key, number] :
       {std::pair{"material.molar_mass_kg_mol", m.molar_mass},
        std::pair{"material.latent_heat_vaporisation_j_kg", m.latent_heat_vaporisation}})
    if (vapour && number == 0)
      refuse(document.place(key), key, "0 with terms.evaporation or terms.recoil, whose vapour it makes",
             "a number > 0");
  if (vapour && m.boiling_temperature > 0 && m.boiling_temperature <= m.liquidus)
    refuse(document.place("material.boiling_temperature_k"), "material.boiling_temperature_k",
           fmt::format("{} K", m.boiling_temperature),
           fmt::format("more than the liquidus, {} K", m.liquidus));
  const Entry* tension = document.find("material.surface_tension_n_m");
  if (tension && tension->value.table() && document.given("material.surface_tension_slope_n_m_k"))
    refuse(document.place("material.surface_tension_slope_n_m_k"), "material.surface_tension_slope_n_m_k",
           "a second slope: surface_tension_n_m has one", "one of the two");
  if (scene.terms.surface_tension && m.surface_tension_floor > m.surface_tension(m.liquidus))
    refuse(document.place("material.surface_tension_floor_n_m"), "material.surface_tension_floor_n_m",
           fmt::format("{} N/m", m.surface_tension_floor),
           fmt::format("at most the surface tension at the liquidus, {} N/m", m.surface_tension(m.liquidus)));
  if (scene.terms.buoyancy && m.expansion == 0) {
    if (document.given("terms.buoyancy"))
      refuse(document.place("terms.buoyancy"), "terms.buoyancy",
             "true with material.expansion_1_k = 0, which gives no buoyancy", "material.expansion_1_k > 0");
    refuse(document.place("model"), "model",
           fmt::format("\"{}\", a row with buoyancy, with material.expansion_1_k = 0, which gives none",
                       scene.model),
           "terms.buoyancy = false with it, or material.expansion_1_k > 0");
  }
  const bool marangoni = scene.terms.marangoni && scene.terms.surface_tension;
  if (marangoni && m.surface_tension.slope(m.liquidus) == 0)
    refuse(document.place("terms.marangoni"), "terms.marangoni",
           "true with a surface tension that does not depend on temperature",
           "a material.surface_tension_slope_n_m_k other than 0");
  if (scene.terms.radiation && m.emissivity == 0)
    refuse(document.place("terms.radiation"), "terms.radiation", "true with material.emissivity = 0",
           "material.emissivity > 0");
}

}  // namespace meltray::scene
