// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/validate/cases.hpp"
#include "meltray/scene/case_file.hpp"
#include "meltray/scene/simulation.hpp"

namespace meltray::app {

/// The scene of validation/<id>/case.toml, or of another file there, with some keys changed.
std::unique_ptr<scene::Simulation> start(const Setting& setting, const scene::Overrides& overrides = {},
                                         const std::string& file = "case.toml");

/// A way to run a scene, and what its rows are called by.
struct Model {
  std::string name;
  scene::Overrides overrides;
};
/// Both solvers for collapsing columns, whose case files are WCSPH.
std::vector<Model> collapse_models();

/// Size of a 2-D strip along x of which the body of the case is all: twelve particles across, as a periodic
/// direction has to be three supports long. `length` and `spacing` [m].
scene::Overrides strip(double length, double spacing);
/// Height of that strip [m].
double strip_height(double spacing);

/// h of a scene whose particles are all alike [m].
double smoothing_length(const scene::Scene& scene);

/// Steps until `end` [s]; `watch` is called after every step.
void advance(scene::Simulation& simulation, double end, const std::function<void()>& watch = {});

/// sqrt(sum m v^2 / sum m) over liquid particles [m/s].
double rms_speed(const Particles& particles);

/// Radius of a ball (disc) of the volume of all particles, which a finite R/dx makes a little different from
/// R.
double equivalent_radius(const Particles& particles, double density);

/// "dx 10 um", "dx 0.02" and the like.
std::string resolution_text(double spacing);

}  // namespace meltray::app
