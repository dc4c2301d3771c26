// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "meltray/scene/closed_box.hpp"
#include "scene/case_check.hpp"
#include "scene/keys.hpp"

namespace meltray::scene {

namespace {

[[noreturn]] void inert(const Document& document, const char* key, const char* why, const char* allowed) {
  refuse(document.place(key), key, fmt::format("true without effect: {}", why), allowed);
}

/// Highest temperature that the scene starts with or is held at.
double hottest(const Scene& scene) {
  double t = 0;
  for (const Body& body : scene.domain.bodies) t = std::max(t, body.temperature);
  for (const Face& face : scene.domain.faces)
    if (face.thermal == ThermalKind::temperature) t = std::max(t, face.temperature);
  return t;
}

bool heated(const Scene& scene) {
  const auto& faces = scene.domain.faces;
  const bool flux = std::any_of(faces.begin(), faces.end(),
                                [](const Face& f) { return f.thermal == ThermalKind::flux && f.flux > 0; });
  return scene.laser || flux || hottest(scene) >= scene.material.liquidus;
}

void check_thermal(const Scene& scene, const Document& document, int index) {
  const Face& face = scene.domain.faces[static_cast<std::size_t>(index)];
  const std::string key = path_of("faces.*.thermal", index);
  if (face.thermal != ThermalKind::adiabatic && !scene.terms.conduction)
    refuse(document.place(key), key, "a heated face without terms.conduction, which carries the heat in",
           "\"adiabatic\", or terms.conduction = true");
  if (face.thermal == ThermalKind::temperature && face.kind == FaceKind::free)
    refuse(document.place(key), key, "\"temperature\" on a free face, which has no wall to hold it",
           "\"adiabatic\", \"flux\", or kind = \"wall\"");
  // Cold solid away from the melt exchanges heat with its kind only.
  if (face.thermal != ThermalKind::adiabatic && scene.heat.bulk_interval > 0)
    refuse(document.place("heat.bulk_interval_s"), "heat.bulk_interval_s",
           fmt::format("{} s with a face that heats or cools ({})", scene.heat.bulk_interval, key), "0 [s]");
}

/// What moves the melt does nothing where nothing flows.
void check_flowing(const Scene& scene, const Document& document) {
  const Terms& t = scene.terms;
  if (t.pressure) {
    if (!t.melting && scene.flow.solid == SolidModel::fixed && !document.given("flow.solid") &&
        hottest(scene) < scene.material.liquidus &&
        !document.may_be_idle("terms.pressure", {"terms.melting"}))
      inert(document, "terms.pressure", "nothing is liquid and nothing melts",
            "terms.melting = true or a liquid body with it");
    return;
  }
  const std::array<std::pair<const char*, bool>, 7> forces = {
      {{"terms.viscosity", t.viscosity},
       {"terms.interface_viscosity", t.interface_viscosity},
       {"terms.artificial_viscosity", t.artificial_viscosity},
       {"terms.surface_tension", t.surface_tension},
       {"terms.recoil", t.recoil},
       {"terms.buoyancy", t.buoyancy},
       {"terms.gravity", t.gravity}}};
  for (const auto& [key, on] : forces)
    if (on && document.given(key) && !document.may_be_idle(key, {"terms.pressure"}))
      inert(document, key, "terms.pressure is off and nothing flows", "terms.pressure = true with it");
}

}  // namespace

void check_terms(const Scene& scene, const Document& document) {
  const Terms& t = scene.terms;
  if (!(t.conduction || t.viscosity || t.interface_viscosity || t.pressure || t.surface_tension || t.recoil ||
        t.evaporation || t.radiation || t.buoyancy || t.gravity || scene.laser))
    refuse(document.place("terms.conduction"), "terms", "no term that acts", "at least one term = true");
  if (t.marangoni && !t.surface_tension)
    inert(document, "terms.marangoni", "terms.surface_tension is off",
          "terms.surface_tension = true with it");
  if (t.wetting && !t.surface_tension)
    inert(document, "terms.wetting", "terms.surface_tension is off", "terms.surface_tension = true with it");
  if (t.gravity && scene.domain.gravity == 0)
    inert(document, "terms.gravity", "domain.gravity_m_s2 is 0", "domain.gravity_m_s2 > 0 with it");
  if (t.buoyancy && scene.domain.gravity == 0)
    inert(document, "terms.buoyancy", "domain.gravity_m_s2 is 0", "domain.gravity_m_s2 > 0 with it");
  if (t.evaporation && !heated(scene))
    inert(document, "terms.evaporation", "nothing heats the material and it starts cold",
          "a laser, a hot face, a flux or a liquid body with it");
  if (t.recoil && scene.surface.recoil_pressure == 0 && !heated(scene))
    inert(document, "terms.recoil", "nothing heats the material and it starts cold",
          "a laser, a hot face, a flux, a liquid body or surface.recoil_pressure_pa with it");
  if (scene.surface.temperature == SurfaceTemperature::face) {
    const char* key = "surface.temperature";
    if (!t.conduction)
      refuse(document.place(key), key, "\"face\" without terms.conduction, which ties it to the particle",
             "\"particle\", or terms.conduction = true");
    if (t.recoil && scene.surface.recoil_pressure == 0 && !t.evaporation)
      refuse(document.place(key), key, "\"face\" with recoil but without the vapour that cools it",
             "\"particle\", or terms.evaporation = true");
  }
  if (t.interface_viscosity && scene.flow.reference_speed == 0)
    refuse(document.place("flow.reference_speed_m_s"), "flow.reference_speed_m_s",
           "0, which switches terms.interface_viscosity off", "a number > 0 [m/s]");
  if (t.interface_viscosity && scene.flow.interface_viscosity_free == 0 &&
      scene.flow.interface_viscosity_solid == 0)
    inert(document, "terms.interface_viscosity", "both its coefficients are 0",
          "flow.interface_viscosity_free or flow.interface_viscosity_solid > 0");
  check_flowing(scene, document);
  if (!scene.flow.free_surface) {
    const bool any_open = !is_closed(scene.domain);
    if (any_open || t.surface_tension || t.recoil || t.evaporation || t.radiation || scene.laser)
      refuse(document.place("flow.free_surface"), "flow.free_surface",
             any_open ? "false with a free face" : "false with a term that acts on the free surface",
             "true, or a closed or periodic box without surface tension, recoil, evaporation, radiation and "
             "laser");
  }
  for (int f = 0; f < 6; ++f)
    if (scene.domain.dimension == 3 || f / 2 != 1) check_thermal(scene, document, f);
}

}  // namespace meltray::scene
