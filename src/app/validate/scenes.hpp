// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>

#include "app/validate/cases.hpp"
#include "meltray/scene/case_file.hpp"
#include "meltray/scene/simulation.hpp"

namespace meltray::app {

/// The scene of validation/<id>/case.toml with some keys changed.
std::unique_ptr<scene::Simulation> start(const Setting& setting, const scene::Overrides& overrides = {});

/// Steps until `end` [s]; `watch` is called after every step.
void advance(scene::Simulation& simulation, double end, const std::function<void()>& watch = {});

/// sqrt(sum m v^2 / sum m) over liquid particles [m/s].
double rms_speed(const Particles& particles);

/// "dx 10 um", "dx 0.02" and the like.
std::string resolution_text(double spacing);

}  // namespace meltray::app
