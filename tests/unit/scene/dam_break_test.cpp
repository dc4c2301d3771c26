// SPDX-License-Identifier: MIT
// A scene whose sums over pairs are all made by the acoustic pass keeps no list of pairs.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <vector>

#include "meltray/scene/case_file.hpp"
#include "meltray/scene/simulation.hpp"

using namespace meltray;

namespace {

std::size_t list_bytes(const scene::Simulation& s) {
  for (const auto& [name, bytes] : s.memory())
    if (name == "pair lists") return bytes;
  return 0;
}

}  // namespace

TEST_CASE("without a list of pairs a dam breaks as with one") {
  const auto simulation = [](const scene::Overrides& viscosity) {
    const auto tests = std::filesystem::path(__FILE__).parent_path() / "../..";
    return scene::Simulation(scene::read_case(tests / "integration/cases/dam_break.toml", viscosity));
  };
  // A viscosity of nothing, which needs a list all the same.
  scene::Simulation without = simulation({}),
                    with = simulation({"terms.viscosity=true", "material.viscosity_pa_s=1e-30"});
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
