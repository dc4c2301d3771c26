// SPDX-License-Identifier: MIT
#include "meltray/scene/presets.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

namespace meltray::scene {

namespace {

/// Shifting coefficient of the rows without artificial viscosity: nothing else keeps their particles in
/// order.
constexpr double kShifting = 4;

struct Choice {
  const char* key;
  std::string found, row;
};

std::vector<Choice> differences(const Scene& s, const Preset& p) {
  const auto text = [](bool on) { return std::string(on ? "true" : "false"); };
  const auto solver = [](FlowSolver f) { return std::string(f == FlowSolver::isph ? "isph" : "wcsph"); };
  const auto solid = [](SolidModel m) { return std::string(m == SolidModel::fixed ? "fixed" : "elastic"); };
  std::vector<Choice> all = {
      {"flow.solver", solver(s.flow.solver), solver(p.solver)},
      {"terms.artificial_viscosity", text(s.terms.artificial_viscosity), text(p.artificial_viscosity)},
      {"terms.interface_viscosity", text(s.terms.interface_viscosity), text(p.interface_viscosity)},
      {"flow.thermal_expansion", text(s.flow.thermal_expansion), text(p.thermal_expansion)},
      {"terms.buoyancy", text(s.terms.buoyancy), text(p.buoyancy)},
      {"flow.solid", solid(s.flow.solid), solid(p.solid)}};
  std::erase_if(all, [](const Choice& c) { return c.found == c.row; });
  return all;
}

}  // namespace

const std::vector<Preset>& presets() {
  static const std::vector<Preset> rows = {
      {.model = "wcsph",
       .solver = FlowSolver::wcsph,
       .artificial_viscosity = true,
       .thermal_expansion = true,
       .solid = SolidModel::elastic},
      {.model = "wcsph_reduced", .solver = FlowSolver::wcsph, .artificial_viscosity = true, .buoyancy = true},
      {.model = "wcsph_reduced_interface",
       .solver = FlowSolver::wcsph,
       .interface_viscosity = true,
       .buoyancy = true,
       .shifting = kShifting},
      {.model = "isph", .interface_viscosity = true, .buoyancy = true, .shifting = kShifting}};
  return rows;
}

const Preset& preset_of(std::string_view model) {
  for (const Preset& p : presets())
    if (p.model == model) return p;
  throw std::logic_error("no such row of Table 1");
}

std::string row_of_table(const Scene& scene) {
  const Preset* nearest = nullptr;
  std::vector<Choice> differs;
  for (const Preset& p : presets()) {
    auto now = differences(scene, p);
    if (nearest && now.size() >= differs.size()) continue;
    nearest = &p;
    differs = std::move(now);
  }
  if (differs.empty()) return std::string(nearest->model);
  std::vector<std::string> texts;
  for (const Choice& c : differs)
    texts.push_back(fmt::format("{} = {} instead of {}", c.key, c.found, c.row));
  return fmt::format("none; nearest \"{}\" with {}", nearest->model, fmt::join(texts, ", "));
}

}  // namespace meltray::scene
