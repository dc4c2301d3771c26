// SPDX-License-Identifier: MIT
// A scene whose sums over pairs are all made by the acoustic pass keeps no list of pairs.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "meltray/core/archive.hpp"
#include "meltray/scene/case_file.hpp"
#include "meltray/scene/simulation.hpp"

using namespace meltray;

namespace {

double bytes_of(const scene::Simulation& s, const std::string& part) {
  for (const auto& [name, bytes] : s.memory())
    if (name == part) return static_cast<double>(bytes);
  return -1;
}

/// Saves nowhere.
class NoArchive final : public Archive {
 public:
  bool loading() const override { return false; }
  void value(std::string_view, double&) override {}
  void value(std::string_view, std::int64_t&) override {}
  void value(std::string_view, std::string&) override {}
  void values(std::string_view, std::vector<double>&) override {}
  void values(std::string_view, std::vector<std::uint8_t>&) override {}
  void values(std::string_view, std::vector<std::int32_t>&) override {}
};

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
  CHECK(bytes_of(without, "pair lists") < 100);
  CHECK(bytes_of(with, "pair lists") > 1000);
  // Two stages of x, v, rho, the state and the new one: no vector more.
  const double state = 5.0 * sizeof(double) * static_cast<double>(without.liquid_count());
  CHECK(bytes_of(without, "state vectors") == Approx(4 * state).epsilon(0.02));
  // Walls far from the water do not take part.
  CHECK(bytes_of(without, "patch and stage") < 0.75 * bytes_of(with, "patch and stage"));
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

TEST_CASE("a checkpoint is written when what is built anew has given its memory back") {
  const auto tests = std::filesystem::path(__FILE__).parent_path() / "../..";
  scene::Simulation simulation(scene::read_case(tests / "integration/cases/dam_break.toml", {}));
  simulation.step(0.3);
  const double state = bytes_of(simulation, "state vectors"),
               acoustic = bytes_of(simulation, "acoustic pass"),
               patch = bytes_of(simulation, "patch and stage");
  CHECK(std::min({state, acoustic, patch}) > 1e4);
  NoArchive archive;
  simulation.archive(archive);
  CHECK(bytes_of(simulation, "acoustic pass") < 0.02 * acoustic);
  CHECK(bytes_of(simulation, "patch and stage") < 0.1 * patch);  // lists of numbers stay
  const double at = simulation.time();
  simulation.step(0.3);
  CHECK(simulation.time() > at);
  CHECK(bytes_of(simulation, "state vectors") == state);
}
