// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "meltray/materials/optics.hpp"
#include "scene/case_check.hpp"

namespace meltray::scene {

namespace {

/// A beam whose axis never meets the box at the focal plane heats nothing.
void check_path(const Scene& scene, const Document& document) {
  const laser::BeamSpec& b = scene.laser->beam;
  const Domain& d = scene.domain;
  if (b.start_y < d.min[1] || b.start_y > d.max[1])
    refuse(document.place("laser.start_y_m"), "laser.start_y_m", fmt::format("{}", b.start_y),
           fmt::format("a place in the domain: {} to {} [m]", d.min[1], d.max[1]));
  const double last = b.start_x + b.feed * scene.time.end;
  if (b.start_x > d.max[0] || last < d.min[0])
    refuse(document.place("laser.start_x_m"), "laser.start_x_m",
           fmt::format("{}: the beam runs from x = {} to {} m", b.start_x, b.start_x, last),
           fmt::format("a path that crosses the domain: {} to {} [m]", d.min[0], d.max[0]));
}

}  // namespace

void check_laser(const Scene& scene, const Document& document) {
  if (!scene.laser) return;
  if (scene.domain.dimension == 2)
    refuse(document.place("laser.power_w"), "laser", "a laser in a 2-D scene",
           "a laser in domain.dimension = 3 only");
  const laser::BeamSpec& b = scene.laser->beam;
  if (b.modulation == laser::Modulation::sine && b.amplitude > b.power)
    refuse(document.place("laser.amplitude_w"), "laser.amplitude_w", fmt::format("{}", b.amplitude),
           fmt::format("at most laser.power_w = {} [W]: power cannot be negative", b.power));
  if (b.off_time <= b.on_time)
    refuse(document.place("laser.off_time_s"), "laser.off_time_s", fmt::format("{}", b.off_time),
           fmt::format("more than laser.on_time_s = {} [s]", b.on_time));
  if (b.on_time >= scene.time.end)
    refuse(document.place("laser.on_time_s"), "laser.on_time_s", fmt::format("{}", b.on_time),
           fmt::format("less than time.end_s = {} [s]: the beam would never be on", scene.time.end));
  check_path(scene, document);
  const laser::TraceOptions& trace = scene.laser->trace;
  const bool fresnel = !trace.fixed_absorptance;
  if (fresnel && !scene.material.has_index())
    refuse(document.place("laser.absorptivity"), "laser.absorptivity",
           fmt::format("\"fresnel\" with material \"{}\", whose refractive index is not known",
                       scene.material.name),
           "a number > 0 and <= 1, or material.refractive_* with it");
  if (scene.laser->optics == Optics::hot_melt && !hot_melt_index(scene.material.name))
    refuse(document.place("laser.optics"), "laser.optics",
           fmt::format("\"hot_melt\" with material \"{}\", of which no such index is known",
                       scene.material.name),
           "\"by_phase\" or \"solid\"");
  const auto& xy = trace.polarisation_xy;
  if (xy[0] == 0 && xy[1] == 0)
    refuse(document.place("laser.polarisation_direction"), "laser.polarisation_direction", "[0, 0]",
           "a direction other than zero");
}

}  // namespace meltray::scene
