// SPDX-License-Identifier: MIT
// A scene whose sums over pairs are all made by the acoustic pass keeps no list of pairs.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "meltray/scene/case_file.hpp"
#include "meltray/scene/simulation.hpp"

using namespace meltray;

namespace {

/// A column of water in a box, with two drops above it.
const char* const kColumn = R"(
[domain]
dimension = 2
min_m = [0.0, 0.0]
max_m = [2.0, 1.5]
spacing_m = 0.05
gravity_m_s2 = 1.0
[faces.x_min]
kind = "wall"
slip = "slip"
[faces.x_max]
kind = "wall"
[faces.z_min]
kind = "wall"
[faces.z_max]
kind = "free"
[[bodies]]
shape = "box"
min_m = [0.0, 0.0]
max_m = [0.5, 1.0]
temperature_k = 400.0
[[bodies]]
shape = "box"
min_m = [1.0, 0.3]
max_m = [1.1, 0.4]
temperature_k = 400.0
[material]
name = "custom"
density_kg_m3 = 1.0
heat_capacity_solid_j_kg_k = 1.0
heat_capacity_liquid_j_kg_k = 1.0
solidus_k = 300.0
liquidus_k = 301.0
viscosity_pa_s = 1e-30
[terms]
artificial_viscosity = true
pressure = true
gravity = true
[flow]
solver = "wcsph"
sound_speed_m_s = 20.0
artificial_viscosity = 0.1
pressure_gradient = "sum"
tension = "full"
[time]
end_s = 1.0
method = "explicit"
[output]
interval_s = 1.0
)";

std::size_t list_bytes(const scene::Simulation& s) {
  for (const auto& [name, bytes] : s.memory())
    if (name == "pair lists") return bytes;
  return 0;
}

}  // namespace

TEST_CASE("without a list of pairs a dam breaks as with one") {
  const auto simulation = [](const std::string& viscosity) {
    return scene::Simulation(scene::read_case_text(kColumn, "column", {"terms.viscosity=" + viscosity}));
  };
  // A viscosity of nothing, which needs a list all the same.
  scene::Simulation without = simulation("false"), with = simulation("true");
  while (without.time() < 0.3) {
    without.step(0.3);
    with.step(0.3);
  }
  CHECK(list_bytes(without) < 100);
  CHECK(list_bytes(with) > 1000);
  const Particles &a = without.particles(), &b = with.particles();
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int c = 0; c < 2; ++c) REQUIRE(a.x[c][i] == Approx(b.x[c][i]).margin(1e-9));
  // The surface of a snapshot is found without disturbing the run.
  const auto surface = without.on_surface();
  CHECK(surface == with.on_surface());
  CHECK(std::count(surface.begin(), surface.end(), 1) > 20);
  while (without.time() < 0.4) {
    without.step(0.4);
    with.step(0.4);
  }
  for (std::size_t i = 0; i < a.size(); ++i) REQUIRE(a.x[0][i] == Approx(b.x[0][i]).margin(1e-9));
}
