// SPDX-License-Identifier: MIT
// Melt that fills its box cannot fall.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "unit/scene/model_setup.hpp"

namespace meltray::scene {
namespace {

std::string full_box(const std::string& floor_and_lid, bool free_surface, double gravity) {
  return fmt::format(R"(
[domain]
dimension = 2
min_m = [0.0, 0.0]
max_m = [1e-3, 1e-3]
spacing_m = 1e-4
gravity_m_s2 = {0}
arrangement = "jittered"
jitter = 0.1
[faces.x_min]
kind = "wall"
[faces.x_max]
kind = "wall"
[faces.z_min]
kind = "{1}"
[faces.z_max]
kind = "{1}"
[[bodies]]
shape = "box"
min_m = [0.0, 0.0]
max_m = [1e-3, 1e-3]
temperature_k = 2100.0
[material]
name = "iron"
[terms]
pressure = true
gravity = true
[flow]
free_surface = {2}
drift_time_s = 1e-5
[time]
end_s = 1e-4
[output]
interval_s = 1e-4
)",
                     gravity, floor_and_lid, free_surface);
}

std::vector<double> rates(const std::string& floor_and_lid, bool free_surface, double gravity) {
  test::ModelSetup box(full_box(floor_and_lid, free_surface, gravity));
  return box.explicit_rate(box.state());
}

}  // namespace

TEST_CASE("gravity is a force but in melt that fills its box between floor and lid") {
  CHECK(rates("wall", true, 1000) != rates("wall", true, 1));
  CHECK(rates("wall", false, 1000) == rates("wall", false, 1));
  CHECK(rates("periodic", false, 1000) != rates("periodic", false, 1));  // nothing holds it
}

}  // namespace meltray::scene
