// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "meltray/scene/case_file.hpp"
#include "scene/build.hpp"
#include "scene/model.hpp"

namespace meltray::scene::test {

/// The terms of a scene as an ODE at their initial state, with every particle in it.
struct ModelSetup {
  static constexpr double kSkin = 0.25;

  explicit ModelSetup(const std::string& text)
      : scene(read_case_text(text, "test.toml")),
        constants(build_constants(scene)),
        particles(build_particles(scene, constants)),
        selector(build_grid(scene, constants, kSkin * constants.spacing), particles),
        model(scene, constants, timers) {
    model.counters = &counters;
    build_lists();
  }

  void build_lists() {
    selector.select_all(particles, model.patch);
    if (model.has_elastic_solid()) selector.mark_elastic(particles, model.patch, scene.flow.elastic_depth);
    std::vector<std::uint8_t> extra(model.patch.size());
    for (Index i = 0; i < model.patch.size(); ++i) extra[i] = !model.patch.wall[i];
    model.pairs.build(model.patch, selector.grid(), kSkin * constants.spacing, extra);
    model.stage.heat = extra;
    terms::prepare_stage(model.stage);
    model.find_pairs(kSkin * constants.spacing, selector.grid().period());
    model.evaluate_patch(0);
  }

  std::vector<double> state() {
    std::vector<double> y;
    model.pack(y, fields);
    return y;
  }
  std::vector<double> explicit_rate(const std::vector<double>& y) {
    std::vector<double> rate(y.size());
    model.explicit_rate(0, y.data(), rate.data());
    return rate;
  }
  std::vector<double> implicit_rate(const std::vector<double>& y) {
    std::vector<double> rate(y.size());
    model.implicit_rate(0, y.data(), rate.data());
    return rate;
  }

  Scene scene;
  terms::SceneConstants constants;
  Timers timers;
  Particles particles;
  PatchSelector selector;
  Counters counters;
  Model model;
  std::vector<StateField> fields;
};

/// Vortices with conduction and a viscosity that depends on temperature, in a periodic box; nothing in it is
/// not smooth.
inline const std::string vortices = R"(
[domain]
dimension = 2
min_m = [0.0, 0.0]
max_m = [1.0, 1.0]
spacing_m = 0.05
velocity_field = "taylor_green"
velocity_scale_m_s = 1.0
[faces.x_min]
kind = "periodic"
[faces.x_max]
kind = "periodic"
[faces.z_min]
kind = "periodic"
[faces.z_max]
kind = "periodic"
[[bodies]]
shape = "box"
min_m = [0.0, 0.0]
max_m = [1.0, 1.0]
temperature_k = 400.0
[material]
name = "custom"
density_kg_m3 = 1.0
heat_capacity_solid_j_kg_k = 1.0
heat_capacity_liquid_j_kg_k = 1.0
conductivity_liquid_w_m_k = { form = "linear", value = 0.02, slope = 1e-4, reference_k = 400.0, min_k = 300.0, max_k = 500.0 }
conductivity_solid_w_m_k = 0.02
latent_heat_fusion_j_kg = 0.0
solidus_k = 250.0
liquidus_k = 251.0
viscosity_pa_s = { form = "linear", value = 0.02, slope = -1e-4, reference_k = 400.0, min_k = 300.0, max_k = 500.0 }
[terms]
conduction = true
viscosity = true
pressure = true
[flow]
pressure_tolerance = 1e-12
[splitting]
projection = "stage"
linear_tolerance = 1e-12
conduction = "implicit"
viscosity = "implicit"
[time]
end_s = 0.04
[output]
interval_s = 1.0
)";

}  // namespace meltray::scene::test
