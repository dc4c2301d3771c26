// SPDX-License-Identifier: MIT
#include "scene/keys_build.hpp"

namespace meltray::scene {

namespace {

Need jittered() {
  return {"domain.arrangement = \"jittered\"", {"domain.arrangement"}, [](const Scene& s, int) {
            return s.domain.arrangement == Arrangement::jittered;
          }};
}

const Face& face(const Scene& s, int i) {
  return s.domain.faces[static_cast<std::size_t>(i)];
}

/// A 2-D scene is the x-z plane: it has no faces in y.
Need has_face() {
  return {"domain.dimension = 3 for faces in y", {"domain.dimension"}, [](const Scene& s, int i) {
            return s.domain.dimension == 3 || (i != 2 && i != 3);
          }};
}

Need wall() {
  return {"kind = \"wall\"", {"faces.*.kind"}, [](const Scene& s, int i) {
            return face(s, i).kind == FaceKind::wall;
          }};
}

Need thermal(const char* text, ThermalKind kind) {
  return {text, {"faces.*.thermal"}, [kind](const Scene& s, int i) { return face(s, i).thermal == kind; }};
}

Need shape(const char* text, ShapeKind kind) {
  return {text, {"bodies.*.shape"}, [kind](const Scene& s, int i) {
            return s.domain.bodies[static_cast<std::size_t>(i)].shape == kind;
          }};
}

}  // namespace

#define FACE(member) MELTRAY_AT(domain.faces[static_cast<std::size_t>(i)].member)
#define BODY(member) MELTRAY_AT(domain.bodies[static_cast<std::size_t>(i)].member)

std::vector<Key> domain_keys() {
  const Need field = {"domain.velocity_field other than \"none\"",
                      {"domain.velocity_field"},
                      [](const Scene& s, int) { return s.domain.velocity_field != VelocityField::none; }};
  const Need weight = {"terms.gravity or terms.buoyancy",
                       {"terms.gravity", "terms.buoyancy"},
                       [](const Scene& s, int) { return s.terms.gravity || s.terms.buoyancy; }};
  return {
      integer("domain.dimension", between(2, 3), MELTRAY_AT(domain.dimension),
              "3, or 2 for the x-z plane; arrays then have the two entries x and z."),
      vector("domain.min_m", "m", any(), MELTRAY_AT(domain.min), "Lower corner of the box.").required(),
      vector("domain.max_m", "m", any(), MELTRAY_AT(domain.max), "Upper corner of the box.").required(),
      number("domain.spacing_m", "m", above(0), MELTRAY_AT(domain.spacing), "Distance of the particles.")
          .required(),
      number("domain.smoothing_ratio", "", between(1, 3), MELTRAY_AT(domain.smoothing_ratio),
             "Smoothing length over particle distance; the kernel reaches two smoothing lengths."),
      word<KernelType>("domain.kernel",
                       {{"wendland_c2", KernelType::wendland_c2}, {"cubic_spline", KernelType::cubic_spline}},
                       MELTRAY_AT(domain.kernel), "Smoothing kernel."),
      word<Arrangement>(
          "domain.arrangement",
          {{"lattice", Arrangement::lattice},
           {"jittered", Arrangement::jittered},
           {"rotated", Arrangement::rotated}},
          MELTRAY_AT(domain.arrangement),
          "Where the particles start: on a lattice, moved at random off it, or on a rotated one."),
      number("domain.jitter", "spacing", between(0, 0.5), MELTRAY_AT(domain.jitter),
             "Largest displacement of a particle off the lattice.")
          .only_if(jittered()),
      integer("domain.seed", between(0, 2147483647), MELTRAY_AT(domain.seed),
              "Seed of the random displacements.")
          .only_if(jittered()),
      number("domain.gravity_m_s2", "m/s^2", between(0, 1e4), MELTRAY_AT(domain.gravity),
             "Acceleration of gravity, downwards (-z).")
          .only_if(weight),
      word<VelocityField>("domain.velocity_field",
                          {{"none", VelocityField::none},
                           {"taylor_green", VelocityField::taylor_green},
                           {"rotation", VelocityField::rotation}},
                          MELTRAY_AT(domain.velocity_field),
                          "Velocity field that is laid over the bodies at the start."),
      number("domain.velocity_scale_m_s", "m/s", at_least(0), MELTRAY_AT(domain.velocity_scale),
             "Largest speed of velocity_field.")
          .only_if(field),
  };
}

std::vector<Key> face_keys() {
  std::vector<Key> keys = {
      word<FaceKind>(
          "faces.*.kind",
          {{"free", FaceKind::free}, {"wall", FaceKind::wall}, {"periodic", FaceKind::periodic}}, FACE(kind),
          "What the face of the box is; a face where the workpiece was cropped is a wall. Periodic "
          "goes on both opposite faces."),
      word<bool>("faces.*.slip", {{"no_slip", false}, {"slip", true}}, FACE(slip),
                 "Whether the melt sticks to the wall.")
          .only_if(wall()),
      vector("faces.*.velocity_m_s", "m/s", any(), FACE(velocity), "Velocity of a moving wall.")
          .only_if(wall()),
      word<ThermalKind>("faces.*.thermal",
                        {{"adiabatic", ThermalKind::adiabatic},
                         {"temperature", ThermalKind::temperature},
                         {"flux", ThermalKind::flux}},
                        FACE(thermal), "Heat through the face: none, or what a temperature or a flux gives.")
          .only_if({"a kind other than \"periodic\"",
                    {"faces.*.kind"},
                    [](const Scene& s, int i) { return face(s, i).kind != FaceKind::periodic; }}),
      number("faces.*.temperature_k", "K", above_to(0, 1e5), FACE(temperature), "Temperature of the face.")
          .required()
          .only_if(thermal("thermal = \"temperature\"", ThermalKind::temperature)),
      number("faces.*.flux_w_m2", "W/m^2", any(), FACE(flux), "Heat flux into the material.")
          .required()
          .only_if(thermal("thermal = \"flux\"", ThermalKind::flux)),
  };
  for (Key& key : keys) key.needs.insert(key.needs.begin(), has_face());
  return keys;
}

std::vector<Key> body_keys() {
  const Need box = shape("shape = \"box\"", ShapeKind::box),
             ball = shape("shape = \"ball\"", ShapeKind::ball);
  return {
      word<ShapeKind>("bodies.*.shape", {{"box", ShapeKind::box}, {"ball", ShapeKind::ball}}, BODY(shape),
                      "Shape of the body; a later body replaces an earlier one where they overlap.")
          .required(),
      vector("bodies.*.min_m", "m", any(), BODY(min), "Lower corner of the body.").required().only_if(box),
      vector("bodies.*.max_m", "m", any(), BODY(max), "Upper corner of the body.").required().only_if(box),
      vector("bodies.*.center_m", "m", any(), BODY(center), "Centre of the ball.").required().only_if(ball),
      vector("bodies.*.radii_m", "m", above(0), BODY(radii),
             "Semi-axes along the coordinates: an ellipsoid is a ball too.")
          .required()
          .only_if(ball),
      number("bodies.*.temperature_k", "K", above_to(0, 1e5), BODY(temperature), "Temperature at the start.")
          .otherwise("heat.initial_temperature_k",
                     [](Scene& s, int i, const Document&) {
                       s.domain.bodies[static_cast<std::size_t>(i)].temperature = s.heat.initial_temperature;
                     }),
      vector("bodies.*.velocity_m_s", "m/s", any(), BODY(velocity), "Velocity at the start."),
      boolean("bodies.*.clamped", BODY(clamped), "Elastic solid that stays at its place and takes stress.")
          .only_if(elastic()),
  };
}

#undef FACE
#undef BODY

}  // namespace meltray::scene
