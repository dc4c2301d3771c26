// SPDX-License-Identifier: MIT

#include "meltray/core/nearest.hpp"
#include "scene/keys_build.hpp"
#include "scene/property_value.hpp"

namespace meltray::scene {

namespace {

Key material_name() {
  Key k{.path = "material.name",
        .kind = Kind::text,
        .unit = "",
        .sentence =
            "Built-in material whose properties hold where they are not given here, or \"custom\" to give "
            "all of them."};
  k.get = [](const Scene& s, int) {  // a material made in code is a custom one for whoever reads the file
    const std::vector<std::string> known = material_names();
    const bool built_in = std::find(known.begin(), known.end(), s.material.name) != known.end();
    return Value{built_in ? s.material.name : std::string("custom")};
  };
  k.set = [](Scene& s, int, const Value& v) {
    std::vector<std::string> known = material_names();
    if (*v.text() == "custom") {
      s.material = {};
      s.material.name = "custom";
    } else if (std::find(known.begin(), known.end(), *v.text()) != known.end()) {
      s.material = material_by_name(*v.text());
    } else {
      known.push_back("custom");
      std::string allowed;
      for (const std::string& name : known) allowed += (allowed.empty() ? "\"" : ", \"") + name + "\"";
      throw Refusal{describe(v), allowed, nearest_name(*v.text(), known)};
    }
  };
  return k.required();
}

Key of_material(Key key) {
  key.default_text = "of the material";
  return key;
}

Key value(const char* name, const char* unit, Range range, double Material::*member, const char* sentence) {
  return of_material(number(
      std::string("material.") + name, unit,
      range, [member](auto& s, int) -> auto& { return s.material.*member; }, sentence));
}

/// `of_formula`: values that a formula may take.
Key property(const char* name, const char* unit, Property Material::*member, const char* sentence,
             Range of_formula = above(0)) {
  Key k{.path = std::string("material.") + name,
        .kind = Kind::property,
        .unit = unit,
        .sentence = sentence,
        .range = above(0)};
  const std::string allowed = k.allowed();
  k.get = [member](const Scene& s, int) { return write_property(s.material.*member); };
  k.set = [member, of_formula, allowed](Scene& s, int, const Value& v) {
    s.material.*member = read_property(v, above(0), of_formula, allowed);
  };
  return of_material(std::move(k));
}

/// Real (0) or imaginary (1) part of a refractive index.
Key index_part(const char* name, Range range, std::complex<double> Material::*member, int part,
               const char* sentence) {
  Key k{.path = std::string("material.") + name,
        .kind = Kind::number,
        .unit = "",
        .sentence = sentence,
        .range = range};
  k.get = [member, part](const Scene& s, int) {
    const auto& m = s.material.*member;
    return Value{part == 0 ? m.real() : m.imag()};
  };
  k.set = [member, part](Scene& s, int, const Value& v) {
    auto& m = s.material.*member;
    m = part == 0 ? std::complex<double>(v.number(), m.imag()) : std::complex<double>(m.real(), v.number());
  };
  return of_material(std::move(k));
}

Key surface_tension_slope() {
  Key k{.path = "material.surface_tension_slope_n_m_k",
        .kind = Kind::number,
        .unit = "N/(m K)",
        .sentence =
            "Shorthand: replaces the slope of surface_tension_n_m, which keeps its value at its reference "
            "temperature (a constant: at the liquidus)."};
  k.get = [](const Scene& s, int) {
    const Property& sigma = s.material.surface_tension;
    return Value{sigma.form == Property::Form::linear ? sigma.b : 0.0};
  };
  k.set = [](Scene& s, int, const Value& v) {
    Material& m = s.material;
    if (m.surface_tension.form == Property::Form::linear)
      m.surface_tension.b = v.number();
    else
      m.surface_tension = linear(m.surface_tension(m.liquidus), v.number(), m.liquidus);
  };
  return of_material(k.alias());
}

}  // namespace

std::vector<Key> material_keys() {
  std::vector<Key> keys = {
      material_name(),
      value("density_kg_m3", "kg/m^3", above(0), &Material::density, "Constant density of both phases."),
      property("density_of_t_kg_m3", "kg/m^3", &Material::density_of_t,
               "Density of the melt over temperature; incompressible flow does not use it.")
          .otherwise("of the material; density_kg_m3 where that is given",
                     [](Scene& s, int, const Document& given) {
                       if (given.given("material.density_kg_m3"))
                         s.material.density_of_t = constant(s.material.density);
                     }),
      value("heat_capacity_solid_j_kg_k", "J/(kg K)", above(0), &Material::heat_capacity_solid,
            "Specific heat capacity of the solid."),
      value("heat_capacity_liquid_j_kg_k", "J/(kg K)", above(0), &Material::heat_capacity_liquid,
            "Specific heat capacity of the melt."),
      property("conductivity_solid_w_m_k", "W/(m K)", &Material::conductivity_solid,
               "Heat conductivity of the solid."),
      property("conductivity_liquid_w_m_k", "W/(m K)", &Material::conductivity_liquid,
               "Heat conductivity of the melt."),
      value("solidus_k", "K", above_to(0, 1e5), &Material::solidus, "Lower end of the melting band."),
      value("liquidus_k", "K", above_to(0, 1e5), &Material::liquidus, "Upper end of the melting band."),
      value("latent_heat_fusion_j_kg", "J/kg", at_least(0), &Material::latent_heat_fusion,
            "Latent heat of fusion."),
      value("boiling_temperature_k", "K", above_to(0, 1e5), &Material::boiling_temperature,
            "Boiling temperature at one standard atmosphere."),
      value("latent_heat_vaporisation_j_kg", "J/kg", at_least(0), &Material::latent_heat_vaporisation,
            "Latent heat of vaporisation."),
      value("molar_mass_kg_mol", "kg/mol", between(0, 1), &Material::molar_mass, "Molar mass of the vapour."),
      property("viscosity_pa_s", "Pa s", &Material::viscosity, "Dynamic viscosity of the melt."),
      property("surface_tension_n_m", "N/m", &Material::surface_tension, "Surface tension before its floor.",
               any()),
      surface_tension_slope(),
      value("surface_tension_floor_n_m", "N/m", at_least(0), &Material::surface_tension_floor,
            "Smallest surface tension; there it no longer depends on temperature.")
          .otherwise("of the material; a tenth of surface_tension_n_m at the liquidus where that is given",
                     [](Scene& s, int, const Document& given) {
                       if (given.given("material.surface_tension_n_m"))
                         s.material.surface_tension_floor =
                             0.1 * s.material.surface_tension(s.material.liquidus);
                     }),
      value("expansion_1_k", "1/K", at_least(0), &Material::expansion,
            "Volumetric expansion of the melt (buoyancy)."),
      value("expansion_reference_k", "K", at_least(0), &Material::expansion_reference,
            "Temperature at which buoyancy is zero."),
      value("linear_expansion_solid_1_k", "1/K", at_least(0), &Material::linear_expansion_solid,
            "Linear expansion of the solid; a fixed solid does not use it."),
      value("youngs_modulus_pa", "Pa", at_least(0), &Material::youngs_modulus,
            "Young's modulus; a fixed solid does not use it."),
      value("poisson_ratio", "", between(-1, 0.5), &Material::poisson_ratio,
            "Poisson's ratio; a fixed solid does not use it."),
      value("emissivity", "", between(0, 1), &Material::emissivity, "Emissivity of the surface."),
      value("contact_angle_deg", "deg", between(0, 180), &Material::contact_angle_deg,
            "Contact angle of the melt on its own solid."),
      index_part("refractive_n_solid", above(0), &Material::index_solid, 0,
                 "Real part of the refractive index n + ik of the solid at the laser wavelength."),
      index_part("refractive_k_solid", at_least(0), &Material::index_solid, 1, "Imaginary part of the same."),
      index_part("refractive_n_liquid", above(0), &Material::index_liquid, 0,
                 "Real part of the refractive index n + ik of the melt at the laser wavelength."),
      index_part("refractive_k_liquid", at_least(0), &Material::index_liquid, 1,
                 "Imaginary part of the same."),
  };
  return keys;
}

}  // namespace meltray::scene
