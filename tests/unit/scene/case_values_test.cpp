// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "meltray/core/errors.hpp"
#include "meltray/scene/case_file.hpp"
#include "unit/scene/case_samples.hpp"

using namespace meltray;
using namespace meltray::scene;
using namespace case_samples;

namespace {

/// write_case is complete and exact, so equal texts are equal scenes.
void goes_round(const std::string& text) {
  const std::string once = write_case(read_case_text(text, "a.toml"));
  const std::string twice = write_case(read_case_text(once, "b.toml"));
  CHECK(once == twice);
}

}  // namespace

TEST_CASE("case file: keys that are not given have the defaults of the scene") {
  const Scene s = read_case_text(weld, "a.toml");
  const Scene d;
  CHECK(s.model == "isph");
  CHECK(s.domain.smoothing_ratio == d.domain.smoothing_ratio);
  CHECK(s.domain.bodies.at(0).temperature == 300);
  CHECK(s.domain.faces[4].kind == FaceKind::wall);
  CHECK(s.domain.faces[5].kind == FaceKind::free);
  CHECK(s.flow.pressure_tolerance == d.flow.pressure_tolerance);
  CHECK(s.time.integrator.method == Method::imex);
  CHECK(s.time.integrator.order == 2);
  CHECK(s.laser->beam.off_time == 1e300);
  CHECK(s.laser->trace.rays == 1000);
  CHECK_FALSE(s.laser->trace.fixed_absorptance.has_value());
  CHECK_FALSE(read_case_text(flat, "a.toml").laser.has_value());
}

TEST_CASE("case file: defaults that follow other keys") {
  CHECK(read_case_text(added(weld, "time", "method = \"euler\""), "a").time.integrator.order == 1);
  const Scene warm = read_case_text(weld + "[heat]\ninitial_temperature_k = 900\n", "a");
  CHECK(warm.domain.bodies[0].temperature == 900);
  const Scene iron = read_case_text(weld, "a");
  CHECK(iron.laser->trace.index_liquid == iron.material.index_liquid);
  const Scene light = read_case_text(added(weld, "material", "density_kg_m3 = 100"), "a");
  CHECK(light.material.density == 100);
  CHECK(light.material.density_of_t(2000) == 100);
  // The floor of iron (0.187 N/m) would act above a tension of 0.1 N/m.
  const Scene weak = read_case_text(added(weld, "material", "surface_tension_n_m = 0.1"), "a");
  CHECK(weak.material.surface_tension_floor == Approx(0.01));
  CHECK(weak.material.sigma(2500) == Approx(0.1));
}

TEST_CASE("case file: units are converted") {
  const Scene s = read_case_text(added(weld, "laser", "feed_m_per_min = 4"), "a");
  CHECK(s.laser->beam.feed == 4.0 / 60);
  CHECK_THAT(write_case(s), Catch::Contains("feed_m_per_min = 4.0 "));
}

TEST_CASE("case file: vectors of a 2-D scene are x and z") {
  const Scene s = read_case_text(flat, "a.toml");
  CHECK(s.domain.max == Vec3(1e-3, 5e-4, 0));
  CHECK_THAT(write_case(s), Catch::Contains("max_m = [0.001, 0.0005]"));
}

TEST_CASE("case file: overrides of a material") {
  const Scene s = read_case_text(
      added(weld, "material",
            "viscosity_pa_s = { form = \"andrade\", a = -3.0, b_k = 1000, min_k = 1800, max_k = 2000 }\n"
            "conductivity_liquid_w_m_k = 40\nsurface_tension_slope_n_m_k = -2e-4"),
      "a.toml");
  const Material iron = material_by_name("iron");
  CHECK(s.material.viscosity(1900) == Approx(std::pow(10.0, -3.0 + 1000.0 / 1900)));
  CHECK(s.material.viscosity(2500) == Approx(std::pow(10.0, -3.0 + 1000.0 / 2000)));
  CHECK(s.material.conductivity_liquid(2500) == 40);
  CHECK(s.material.surface_tension(1811) == Approx(iron.surface_tension(1811)));
  CHECK(s.material.surface_tension.slope(2000) == -2e-4);
  CHECK(s.material.density == iron.density);
  const Scene custom = read_case_text(
      replaced(
          flat, "name = \"iron\"",
          "name = \"custom\"\ndensity_kg_m3 = 1\nheat_capacity_solid_j_kg_k = 2\nheat_capacity_liquid_j_kg_k "
          "= 3\n"
          "solidus_k = 400\nliquidus_k = 401\nlatent_heat_fusion_j_kg = 4\nconductivity_solid_w_m_k = 5\n"
          "conductivity_liquid_w_m_k = 6"),
      "a.toml");
  CHECK(custom.material.heat_capacity_liquid == 3);
}

TEST_CASE("case file: a resolved case reads back as the same scene") {
  goes_round(weld);
  goes_round(flat);
  goes_round(replaced(weld, "\"sample\"", "\"quotes \\\" and \\\\ and \\t\""));
  goes_round(added(
      weld, "laser",
      "modulation = \"sine\"\namplitude_w = 333.3333333333333\nfrequency_hz = 250\nfeed_m_per_min = 7.3\n"
      "absorptivity = 0.35\noff_time_s = 5e-4\nincidence_deg = 10\ntilt = \"trailing\""));
  goes_round(replaced(weld, "power_w = 1000", "modulation = \"table\"\npower_table = [[0, 1], [0.1, 5.5]]"));
  goes_round(added(weld, "laser", "polarisation = \"tracked\"\npolarisation_direction = [0, 1]"));
  goes_round(added(added(weld, "time", "method = \"explicit\"\norder = 4\nfixed_step_s = 1e-7"), "terms",
                   "recoil = true") +
             "[surface]\nrecoil_pressure_pa = 1e5\nrecoil_ramp_s = 1e-4\nentry = \"pressure\"\n");
  goes_round(replaced(
      weld, "[faces.z_min]\nkind = \"wall\"",
      "[faces.x_min]\nkind = \"periodic\"\n[faces.x_max]\nkind = \"periodic\"\n[faces.z_min]\nkind = "
      "\"wall\"\nslip = \"slip\"\nvelocity_m_s = [0.1, 0, 0]\nthermal = \"flux\"\nflux_w_m2 = -1e6"));
}

TEST_CASE("case file: a resolved case keeps values that have no effect, and a fork can bring them back") {
  const std::string base =
      added(weld, "terms", "interface_viscosity = true") + "[flow]\nreference_speed_m_s = 50.0\n";
  const Scene off = read_case_text(base, "a.toml", {"terms.interface_viscosity=false"});
  const std::string text = write_case(off);
  CHECK_THAT(text, Catch::Contains("reference_speed_m_s = 50.0") && Catch::Contains("No effect here"));
  const Scene on = read_case_text(text, "b.toml", {"terms.interface_viscosity=true"});
  CHECK(on.flow.reference_speed == 50);
  CHECK_THROWS_AS(read_case_text(text, "b.toml", {"laser.amplitude_w=5"}), UsageError);
}

TEST_CASE("case file: every number of feed reads back with the same bits") {
  Scene s = read_case_text(weld, "a.toml");
  for (int k = 1; k < 500; ++k) {
    s.laser->beam.feed = (0.1 * k) / 60;
    CHECK(read_case_text(write_case(s), "b.toml").laser->beam.feed == s.laser->beam.feed);
  }
}

TEST_CASE("case file: the key reference names every key of a resolved case with a sentence") {
  const std::string page = key_reference();
  std::istringstream lines(write_case(read_case_text(weld, "a.toml")));
  for (std::string line; std::getline(lines, line);) {
    const auto equals = line.find(" = ");
    if (line.empty() || line[0] == '#' || line[0] == '[') continue;
    REQUIRE(equals != std::string::npos);
    INFO(line);
    CHECK(page.find("| `" + line.substr(0, equals) + "` |") != std::string::npos);
    CHECK((line.find(" # ") != std::string::npos || line == "resolved = true"));
  }
}
