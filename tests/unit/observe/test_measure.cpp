// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "meltray/observe/history.hpp"
#include "meltray/scene/case_file.hpp"
#include "meltray/scene/simulation.hpp"

using namespace meltray;

namespace {

/// A plate of iron with a notch, 0.4 mm wide and 0.4 mm deep, on whose ground the metal is as hot as `ground`
/// [K]; without `sides` only the ground is there.
scene::Scene notch(double ground, bool sides) {
  const auto box = [](const char* x, double z0, double z1, double t) {
    return fmt::format(
        "[[bodies]]\nshape = \"box\"\nmin_m = [{0}, {1}]\nmax_m = [{2}, {3}]\ntemperature_k = {4}\n",
        std::string(x).substr(0, 6), z0, std::string(x).substr(7), z1, t);
  };
  std::string text =
      "[domain]\ndimension = 2\nmin_m = [0.0, -1e-3]\nmax_m = [2e-3, 1e-3]\nspacing_m = 5e-5\n"
      "[material]\nname = \"iron\"\n[terms]\nconduction = true\n[time]\nend_s = 1e-5\n[output]\ninterval_s = "
      "1e-5\n";
  text += box("0.8e-3 1.2e-3", -1e-3, -0.4e-3, ground);
  if (sides) text += box("0.0e-3 0.8e-3", -1e-3, 0, 300) + box("1.2e-3 2.0e-3", -1e-3, 0, 300);
  return scene::read_case_text(text, "notch.toml");
}

double depth(const scene::Scene& scene) {
  const scene::Simulation simulation(scene);
  return observe::measure(simulation, {}).capillary_depth;
}

}  // namespace

TEST_CASE("measured depth of the void of a plane scene", "[capillary]") {
  CHECK(depth(notch(2000, true)) == Approx(0.4e-3).margin(0.25 * 5e-5));
  // Without melt there is no capillary, without solid no workpiece that one could be in.
  CHECK(depth(notch(1000, true)) == 0);
  CHECK(depth(notch(2000, false)) == 0);
}
