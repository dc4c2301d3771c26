// SPDX-License-Identifier: MIT
#include "scene/keys_build.hpp"

namespace meltray::scene {

namespace {

Need modulation(const char* text, laser::Modulation kind) {
  return {
      text, {"laser.modulation"}, [kind](const Scene& s, int) { return s.laser->beam.modulation == kind; }};
}

Need fresnel() {
  return {"laser.absorptivity = \"fresnel\"", {"laser.absorptivity"}, [](const Scene& s, int) {
            return !s.laser->trace.fixed_absorptance.has_value();
          }};
}

Need tracked() {
  return {"laser.polarisation = \"tracked\"", {"laser.polarisation"}, [](const Scene& s, int) {
            return s.laser->trace.polarisation == laser::Polarisation::tracked;
          }};
}

Key power_table(const Need& table) {
  Key k{.path = "laser.power_table",
        .kind = Kind::power_table,
        .unit = "s, W",
        .sentence =
            "Power over time: a CSV file time_s,power_w (path relative to the case file) or an array of "
            "[time, power]; linear in between, the end values are held."};
  k.get = [](const Scene& s, int) {
    Array rows;
    for (const auto& [time, power] : s.laser->beam.table) rows.push_back(array_of({time, power}));
    return Value{std::move(rows)};
  };
  return k.required().only_if(table);
}

Key absorptivity() {
  Key k{.path = "laser.absorptivity",
        .kind = Kind::number,
        .unit = "",
        .sentence = "Absorbed share at each hit: after Fresnel from the refractive index, or one number.",
        .range = above_to(0, 1),
        .words = {"fresnel"}};
  k.get = [](const Scene& s, int) {
    const auto& fixed = s.laser->trace.fixed_absorptance;
    return fixed ? Value{*fixed} : Value{"fresnel"};
  };
  k.set = [](Scene& s, int, const Value& v) {
    s.laser->trace.fixed_absorptance = v.is_number() ? std::optional<double>(v.number()) : std::nullopt;
  };
  return k;
}

Key polarisation_direction() {
  Key k{.path = "laser.polarisation_direction",
        .kind = Kind::vector,
        .unit = "",
        .sentence = "Direction of the electric field in the cross-section of the incoming beam.",
        .entries = 2};
  k.get = [](const Scene& s, int) {
    const auto& xy = s.laser->trace.polarisation_xy;
    return array_of({xy[0], xy[1]});
  };
  k.set = [](Scene& s, int, const Value& v) {
    const Array& a = *v.array();
    s.laser->trace.polarisation_xy = {a[0].number(), a[1].number()};
  };
  return k.only_if(fresnel()).only_if(tracked());
}

std::vector<Key> power_keys() {
  const Need sine = modulation("laser.modulation = \"sine\"", laser::Modulation::sine);
  const Need no_table = {
      "laser.modulation other than \"table\"", {"laser.modulation"}, [](const Scene& s, int) {
        return s.laser->beam.modulation != laser::Modulation::table;
      }};
  return {
      word<laser::Modulation>("laser.modulation",
                              {{"constant", laser::Modulation::constant},
                               {"sine", laser::Modulation::sine},
                               {"table", laser::Modulation::table}},
                              MELTRAY_AT(laser->beam.modulation), "How the power changes in time."),
      number("laser.power_w", "W", above_to(0, 1e6), MELTRAY_AT(laser->beam.power),
             "Constant power, or mean of the sine.")
          .required()
          .only_if(no_table),
      number("laser.amplitude_w", "W", above_to(0, 1e6), MELTRAY_AT(laser->beam.amplitude),
             "Amplitude of the sine: power_w + amplitude_w sin(2 pi frequency_hz t + phase_deg).")
          .required()
          .only_if(sine),
      number("laser.frequency_hz", "Hz", above(0), MELTRAY_AT(laser->beam.frequency),
             "Frequency of the sine.")
          .required()
          .only_if(sine),
      number("laser.phase_deg", "deg", between(-360, 360), MELTRAY_AT(laser->beam.phase_deg),
             "Phase of the sine at t = 0.")
          .only_if(sine),
      power_table(modulation("laser.modulation = \"table\"", laser::Modulation::table)),
      number("laser.on_time_s", "s", at_least(0), MELTRAY_AT(laser->beam.on_time),
             "The beam is dark before."),
      number_or_unlimited("never", "laser.off_time_s", "s", above(0), MELTRAY_AT(laser->beam.off_time),
                          "The beam is dark from here on."),
  };
}

std::vector<Key> beam_keys() {
  const Need tilted = {"laser.incidence_deg > 0", {"laser.incidence_deg"}, [](const Scene& s, int) {
                         return s.laser->beam.incidence_deg > 0;
                       }};
  return {
      word<laser::Profile>("laser.profile",
                           {{"gaussian", laser::Profile::gaussian}, {"top_hat", laser::Profile::top_hat}},
                           MELTRAY_AT(laser->beam.profile), "Intensity over the cross-section."),
      number(
          "laser.focal_diameter_m", "m", above_to(0, 0.1), MELTRAY_AT(laser->beam.focal_diameter),
          "Diameter in the focal plane, at 1/e^2 of the intensity (gaussian) or the full width (top_hat)."),
      number("laser.focus_z_m", "m", any(), MELTRAY_AT(laser->beam.focus_z),
             "Height of the focal plane; the top of the workpiece is z = 0."),
      number_or_unlimited("infinite", "laser.rayleigh_length_m", "m", above(0),
                          MELTRAY_AT(laser->beam.rayleigh_length),
                          "Distance from the focus at which the cross-section is twice as large."),
      number("laser.incidence_deg", "deg", between(0, 80), MELTRAY_AT(laser->beam.incidence_deg),
             "Angle of the beam to the vertical, in the x-z plane."),
      word<laser::Tilt>("laser.tilt",
                        {{"leading", laser::Tilt::leading}, {"trailing", laser::Tilt::trailing}},
                        MELTRAY_AT(laser->beam.tilt),
                        "Whether the beam points along the feed (leading) or against it as it goes down.")
          .only_if(tilted),
      number("laser.start_x_m", "m", any(), MELTRAY_AT(laser->beam.start_x), "x of the focus at t = 0."),
      number("laser.start_y_m", "m", any(), MELTRAY_AT(laser->beam.start_y), "y of the focus."),
      number_in(60, "laser.feed_m_per_min", "m/min", between(0, 1e5), MELTRAY_AT(laser->beam.feed),
                "Speed of the beam along +x."),
  };
}

std::vector<Key> trace_keys() {
  return {
      integer("laser.rays", between(1, 10000000), MELTRAY_AT(laser->trace.rays),
              "Rays of one trace; with an error target the most of them."),
      number("laser.ray_error", "", between(0, 1), MELTRAY_AT(laser->trace.ray_error),
             "Error target that sets the number of rays: share of the absorbed light that the two halves of "
             "the rays put into different places, two spacings wide; 0 for always `rays`."),
      absorptivity(),
      word<Optics>("laser.optics",
                   {{"by_phase", Optics::by_phase}, {"solid", Optics::solid}, {"hot_melt", Optics::hot_melt}},
                   MELTRAY_AT(laser->optics),
                   "Refractive index of the melt: its own, that of the solid, or that of melt near boiling.")
          .only_if(fresnel()),
      word<laser::Polarisation>(
          "laser.polarisation",
          {{"averaged", laser::Polarisation::averaged}, {"tracked", laser::Polarisation::tracked}},
          MELTRAY_AT(laser->trace.polarisation),
          "Mean of both polarisations at every hit, or the field followed along each ray.")
          .only_if(fresnel()),
      polarisation_direction(),
      number("laser.end_fraction", "", above_to(0, 0.5), MELTRAY_AT(laser->trace.end_fraction),
             "A ray ends when it has less than this share of its own power; the rest is deposited."),
      integer("laser.max_bounces", between(1, 1000000), MELTRAY_AT(laser->trace.max_bounces),
              "A ray ends after this many hits; the rest is deposited."),
      word<bool>("laser.reflection", {{"mirror", false}, {"diffuse", true}}, MELTRAY_AT(laser->trace.diffuse),
                 "Reflection as from a mirror, or from a matt surface (for tests of cavities)."),
      number("laser.retrace_interval_s", "s", above(0), MELTRAY_AT(laser->retrace_interval),
             "The beam is traced again at the latest after this time."),
      number("laser.retrace_motion", "spacing", above_to(0, 10), MELTRAY_AT(laser->retrace_motion),
             "The beam is traced again when a particle of the surface has moved this far."),
  };
}

}  // namespace

std::vector<Key> laser_keys() {
  std::vector<Key> keys = power_keys();
  append(keys, beam_keys());
  append(keys, trace_keys());
  return keys;
}

}  // namespace meltray::scene
