// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "meltray/core/errors.hpp"
#include "meltray/scene/case_file.hpp"
#include "unit/scene/case_samples.hpp"

using meltray::UsageError;
using meltray::scene::read_case_text;
using namespace case_samples;

namespace {

/// A malformed case and the parts its message has to contain, the place first.
struct Malformed {
  std::string name, text;
  std::vector<std::string> parts;
  std::vector<std::string> set = {};
};

std::string message(const Malformed& m) {
  try {
    read_case_text(m.text, "a.toml", m.set);
  } catch (const UsageError& e) {
    return e.what();
  }
  return "(accepted)";
}

void all_refused(const std::vector<Malformed>& cases) {
  for (const Malformed& m : cases) {
    const std::string what = message(m);
    INFO(m.name << ": " << what);
    for (const std::string& part : m.parts) {
      INFO("part: " << part);
      CHECK(what.find(part) != std::string::npos);
    }
  }
}

const std::string sine =
    added(replaced(weld, "power_w = 1000", "power_w = 1000\nmodulation = \"sine\""), "time", "");

std::string faced(const std::string& lines) {
  return replaced(weld, "[faces.z_min]\nkind = \"wall\"\n", lines);
}

}  // namespace

TEST_CASE("case file: TOML syntax errors carry their line") {
  all_refused({
      {"unclosed string", "title = \"abc\n", {"a.toml:1: TOML syntax: "}},
      {"unclosed section", "title = \"a\"\n[domain\n", {"a.toml:2: TOML syntax: "}},
      {"no value", "title = \"a\"\n\n[time]\nend_s =\n", {"a.toml:4: TOML syntax: "}},
      {"unclosed array", added(weld, "domain", "velocity = [1, 2"), {"a.toml:", "TOML syntax: "}},
      {"override", weld, {"--set: time.end_s: TOML syntax"}, {"time.end_s=[1,"}},
      {"override without =", weld, {"--set: 'time.end_s'", "allowed section.key=value"}, {"time.end_s"}},
  });
}

TEST_CASE("case file: unknown keys name the nearest known one") {
  all_refused({
      {"typing error",
       replaced(weld, "spacing_m", "spacng_m"),
       {"a.toml:6: domain.spacng_m: found an unknown key", "did you mean 'domain.spacing_m'?"}},
      {"unknown section", weld + "[lasre]\n", {"a.toml:34: lasre", "did you mean 'laser'?"}},
      {"key of another section",
       added(weld, "laser", "end_s = 1"),
       {"laser.end_s", "did you mean 'time.end_s'?"}},
      {"unknown face",
       faced("[faces.z_mim]\nkind = \"wall\"\n"),
       {"a.toml:9: faces.z_mim.kind", "did you mean 'faces.z_min.kind'?"}},
      {"key of a body",
       added(weld, "[bodies]", "radius_m = [1, 1, 1]"),
       {"bodies.0.radius_m", "'bodies.0.radii_m'"}},
      {"top level",
       "titel = \"x\"\n" + flat,
       {"a.toml:1: titel: found an unknown key", "did you mean 'title'?"}},
      {"other unit",
       added(weld, "laser", "feed_mm_per_min = 4000"),
       {"laser.feed_mm_per_min", "did you mean 'laser.feed_m_per_min'?"}},
      {"in an override",
       weld,
       {"--set: laser.powr_w: found an unknown key", "did you mean 'laser.power_w'?"},
       {"laser.powr_w=3"}},
      {"quoted path", "\"time.end_s\" = 1\n" + weld, {"a.toml:1: \"time.end_s\": found an unknown key"}},
      {"a body that is not there",
       weld,
       {"--set: bodies.3", "body '3' of 1", "0 to 0"},
       {"bodies.3.temperature_k=5"}},
  });
}

TEST_CASE("case file: values of the wrong type") {
  all_refused({
      {"text for a number",
       replaced(weld, "spacing_m = 5e-5", "spacing_m = \"5e-5\""),
       {"a.toml:6: domain.spacing_m: found \"5e-5\" (text); allowed a number > 0 [m]"}},
      {"boolean for a number",
       replaced(weld, "end_s = 1e-3", "end_s = true"),
       {"time.end_s: found true (boolean)"}},
      {"number for a boolean",
       added(weld, "terms", "recoil = 1"),
       {"terms.recoil: found 1; allowed true or false"}},
      {"fraction for an integer",
       added(weld, "laser", "rays = 1.5"),
       {"laser.rays: found 1.5; allowed an integer"}},
      {"number for a word",
       added(weld, "domain", "kernel = 2"),
       {"domain.kernel: found 2; allowed \"wendland_c2\""}},
      {"unknown word",
       added(weld, "laser", "profile = \"gausian\""),
       {"laser.profile: found \"gausian\"", "\"gaussian\", \"top_hat\"", "did you mean 'gaussian'?"}},
      {"unknown material",
       replaced(weld, "\"iron\"", "\"irom\""),
       {"material.name: found \"irom\"", "'iron'"}},
      {"number for a vector",
       replaced(weld, "min_m = [0.0, -4e-4, -8e-4]", "min_m = 0"),
       {"domain.min_m: found 0"}},
      {"2 entries in 3-D",
       replaced(weld, "min_m = [0.0, -4e-4, -8e-4]", "min_m = [0.0, -8e-4]"),
       {"domain.min_m", "with 2 entries", "allowed 3 entries"}},
      {"value for a section", "laser = 5\n" + flat, {"a.toml:1: laser: found 5; allowed a table: [laser]"}},
      {"table for a value", flat + "[output.interval_s]\nx = 1\n", {"output.interval_s"}},
      {"bodies as one table",
       replaced(weld, "[[bodies]]", "[bodies]"),
       {"bodies.", "[[bodies]] in double brackets"}},
      {"a date", replaced(weld, "end_s = 1e-3", "end_s = 2024-01-01"), {"time.end_s: found a date or time"}},
      {"word in an override", weld, {"--set: time.end_s: found \"soon\" (text)"}, {"time.end_s=soon"}},
  });
}

TEST_CASE("case file: values out of range") {
  all_refused({
      {"negative spacing",
       replaced(weld, "spacing_m = 5e-5", "spacing_m = -5e-5"),
       {"domain.spacing_m: found -5e-05"}},
      {"dimension 1",
       added(weld, "domain", "dimension = 1"),
       {"domain.dimension: found 1; allowed an integer from 2 to 3"}},
      {"power 0",
       replaced(weld, "power_w = 1000", "power_w = 0"),
       {"laser.power_w: found 0; allowed a number > 0"}},
      {"grazing beam",
       added(weld, "laser", "incidence_deg = 95"),
       {"laser.incidence_deg: found 95", "[deg]"}},
      {"absorptivity above 1", added(weld, "laser", "absorptivity = 1.2"), {"laser.absorptivity: found 1.2"}},
      {"order 6", added(weld, "time", "order = 6"), {"time.order: found 6; allowed an integer from 1 to 5"}},
      {"cold", added(weld, "[bodies]", "temperature_k = -20"), {"bodies.0.temperature_k: found -20", "[K]"}},
      {"contact angle",
       added(weld, "material", "contact_angle_deg = 200"),
       {"contact_angle_deg: found 200", "to 180"}},
      {"too many particles",
       replaced(weld, "spacing_m = 5e-5", "spacing_m = 1e-9"),
       {"domain.spacing_m", "particles"}},
      {"radius 0",
       replaced(weld, "shape = \"box\"\nmin_m = [0.0, -4e-4, -8e-4]\nmax_m = [1e-3, 4e-4, 0.0]",
                "shape = \"ball\"\ncenter_m = [5e-4, 0, 0]\nradii_m = [1e-4, 0, 1e-4]"),
       {"bodies.0.radii_m: found [0.0001, 0, 0.0001] (array)", "> 0"}},
  });
}

TEST_CASE("case file: numbers that are not finite") {
  all_refused({
      {"nan",
       replaced(weld, "end_s = 1e-3", "end_s = nan"),
       {"time.end_s: found nan; allowed finite numbers"}},
      {"inf",
       replaced(weld, "power_w = 1000", "power_w = inf"),
       {"laser.power_w: found inf; allowed finite"}},
      {"in a vector", replaced(weld, "max_m = [1e-3", "max_m = [inf"), {"domain.max_m", "finite"}},
      {"in a property",
       added(weld, "material",
             "viscosity_pa_s = { form = \"linear\", value = nan, slope = 0, reference_k = 1 }"),
       {"material.viscosity_pa_s: found value = nan", "finite"}},
      {"in an override", weld, {"--set: time.rtol: found nan"}, {"time.rtol=nan"}},
  });
}

TEST_CASE("case file: duplicates") {
  all_refused({
      {"key twice", added(weld, "time", "end_s = 2e-3"), {"a.toml:31: TOML syntax: ", "end_s"}},
      {"section twice", weld + "[time]\nrtol = 1e-3\n", {"a.toml:34: TOML syntax: ", "time"}},
      {"a face in two ways", "faces.z_min.kind = \"free\"\n" + weld, {"a.toml:9: TOML syntax: ", "z_min"}},
      {"two overrides", weld, {"--set: time.end_s: found a duplicate"}, {"time.end_s=1", "time.end_s=2"}},
      {"two overrides in two ways",
       weld,
       {"--set: faces.x_min.kind: found a duplicate"},
       {"faces.x_min.kind=wall", "faces.x_min={kind = \"free\"}"}},
  });
}

TEST_CASE("case file: required keys") {
  all_refused({
      {"spacing", replaced(weld, "spacing_m = 5e-5\n", ""), {"a.toml:3: domain.spacing_m: found nothing"}},
      {"material", replaced(weld, "name = \"iron\"\n", ""), {"material.name: found nothing"}},
      {"end",
       replaced(weld, "end_s = 1e-3\n", ""),
       {"time.end_s: found nothing", "allowed a number > 0 [s]"}},
      {"interval", replaced(weld, "interval_s = 1e-5\n", ""), {"output.interval_s: found nothing"}},
      {"power", replaced(weld, "power_w = 1000\n", ""), {"a.toml:26: laser.power_w: found nothing"}},
      {"body",
       replaced(flat, "[[bodies]]\nshape = \"box\"\nmin_m = [0.0, 0.0]\nmax_m = [1e-3, 5e-4]\n", ""),
       {"bodies: found no body", "[[bodies]]"}},
      {"frequency of a sine",
       added(sine, "laser", "amplitude_w = 10"),
       {"laser.frequency_hz: found nothing"}},
      {"temperature of a face",
       added(weld, "faces.z_min", "thermal = \"temperature\""),
       {"faces.z_min.temperature_k: found nothing", "[K]"}},
      {"property of a custom material",
       replaced(weld, "name = \"iron\"", "name = \"custom\""),
       {"material.density_kg_m3: found nothing"}},
  });
}

TEST_CASE("case file: contradictions") {
  all_refused({
      {"domain upside down",
       replaced(weld, "max_m = [1e-3, 4e-4, 4e-4]", "max_m = [1e-3, 4e-4, -9e-4]"),
       {"a.toml:5: domain.max_m: found -0.0009 in z", "max_m > min_m"}},
      {"periodic on one side",
       faced("[faces.x_min]\nkind = \"periodic\"\n"),
       {"a.toml:9: faces.x_min.kind", "faces.x_max.kind as well"}},
      {"period between particles",
       replaced(faced("[faces.x_min]\nkind = \"periodic\"\n[faces.x_max]\nkind = \"periodic\"\n"), "5e-5",
                "5.1e-5"),
       {"domain.spacing_m", "whole number"}},
      {"a body elsewhere",
       replaced(weld, "max_m = [1e-3, 4e-4, 0.0]", "max_m = [1e-3, 4e-4, -8.1e-4]"),
       {"bodies.0.max_m"}},
      {"order 1 of imex",
       added(weld, "time", "order = 1"),
       {"time.order: found 1 with method \"imex\"", "2 to 5"}},
      {"order 2 of euler",
       added(weld, "time", "method = \"euler\"\norder = 2"),
       {"time.order: found 2 with method \"euler\""}},
      {"multirate without its slow step",
       added(weld, "time", "method = \"multirate\""),
       {"time.fixed_step_s: found 0 with time.method = \"multirate\""}},
      {"multirate with a projection once a step",
       added(weld, "time", "method = \"multirate\"\nfixed_step_s = 1e-6"),
       {"splitting.projection: found \"step\"", "\"stage\""}},
      {"order 2 of multirate",
       added(weld, "time", "method = \"multirate\"\nfixed_step_s = 1e-6\norder = 2"),
       {"time.order: found 2 with method \"multirate\"", "3 or 4"}},
      {"solidus above liquidus",
       added(weld, "material", "solidus_k = 1900"),
       {"material.solidus_k", "solidus_k < liquidus_k"}},
      {"dark before it is lit",
       added(weld, "laser", "on_time_s = 2e-4\noff_time_s = 1e-4"),
       {"laser.off_time_s: found 0.0001", "more than laser.on_time_s"}},
      {"laser in 2-D", flat + "[laser]\npower_w = 5\n", {"laser: found a laser in a 2-D scene"}},
      {"negative power",
       added(sine, "laser", "amplitude_w = 1001\nfrequency_hz = 5"),
       {"laser.amplitude_w: found 1001"}},
      {"unsorted table",
       replaced(weld, "power_w = 1000", "modulation = \"table\"\npower_table = [[0, 1], [2, 5], [1, 5]]"),
       {"laser.power_table: found row 3: time 1 s after 2 s", "rise"}},
      {"missing table",
       replaced(weld, "power_w = 1000", "modulation = \"table\"\npower_table = \"nowhere.csv\""),
       {"laser.power_table: found no readable file at 'nowhere.csv'"}},
      {"implicit term of an explicit method",
       weld + "[splitting]\nconduction = \"implicit\"\n",
       {"splitting.conduction: found \"implicit\" with time.method = \"explicit\""},
       {"time.method=explicit"}},
      {"non-smooth term implicit",
       weld + "[splitting]\nsurface_tension = \"implicit\"\n",
       {"a.toml:35: splitting.surface_tension: found \"implicit\"", "not smooth"}},
      {"beam beside the workpiece",
       added(weld, "laser", "start_y_m = 1e-2"),
       {"laser.start_y_m: found 0.01"}},
      {"metal without a refractive index",
       replaced(weld, "\"iron\"", "\"ti64\""),
       {"laser.absorptivity", "not known"}},
      {"smallest step above the largest",
       added(weld, "time", "min_step_s = 1e-5\nmax_step_s = 1e-6"),
       {"time.min_step_s: found 1e-05", "less than time.max_step_s"}},
      {"two slopes",
       added(weld, "material",
             "surface_tension_slope_n_m_k = -1e-4\nsurface_tension_n_m = { form = \"linear\", value = 1.8, "
             "slope = "
             "-4e-4, reference_k = 1811 }"),
       {"material.surface_tension_slope_n_m_k: found a second slope"}},
  });
}

TEST_CASE("case file: combinations without effect") {
  all_refused({
      {"amplitude of constant power",
       added(weld, "laser", "amplitude_w = 5"),
       {"a.toml:27: laser.amplitude_w: found 5, which has no effect here", "laser.modulation = \"sine\""}},
      {"first step of fixed steps",
       added(weld, "time", "fixed_step_s = 1e-6\ninitial_step_s = 1e-7"),
       {"time.initial_step_s", "time.fixed_step_s = 0"}},
      {"interface viscosity off",
       weld + "[flow]\ninterface_viscosity_free = 1.0\n",
       {"a.toml:35: flow.interface_viscosity_free", "terms.interface_viscosity = true"}},
      {"pressure off",
       flat + "[flow]\npressure_tolerance = 1e-4\n",
       {"flow.pressure_tolerance", "terms.pressure = true"}},
      {"conduction off",
       replaced(weld, "conduction = true", "conduction = false") + "[splitting]\nconduction = \"implicit\"\n",
       {"splitting.conduction", "terms.conduction = true"}},
      {"bulk interval without conduction",
       replaced(weld, "conduction = true\n", "") + "[heat]\nbulk_interval_s = 1e-5\n",
       {"heat.bulk_interval_s", "terms.conduction = true"}},
      {"slip on a free face",
       added(faced("[faces.z_max]\nkind = \"free\"\n"), "faces.z_max", "slip = \"no_slip\""),
       {"faces.z_max.slip", "kind = \"wall\""}},
      {"temperature of an adiabatic face",
       added(weld, "faces.z_min", "temperature_k = 300"),
       {"faces.z_min.temperature_k", "thermal = \"temperature\""}},
      {"marangoni alone",
       added(flat, "terms", "marangoni = true"),
       {"terms.marangoni: found true without effect", "terms.surface_tension"}},
      {"wetting alone", added(flat, "terms", "wetting = true"), {"terms.wetting: found true without effect"}},
      {"marangoni of a constant",
       added(added(weld, "terms", "marangoni = true"), "material", "surface_tension_n_m = 1.8"),
       {"terms.marangoni", "does not depend on temperature"}},
      {"recoil of cold metal",
       added(flat, "terms", "recoil = true"),
       {"terms.recoil: found true without effect", "starts cold"}},
      {"evaporation of cold metal",
       added(flat, "terms", "evaporation = true"),
       {"terms.evaporation", "starts cold"}},
      {"faces that nothing ties to the particles",
       replaced(added(weld, "terms", "evaporation = true"), "conduction = true\n", "") +
           "[surface]\ntemperature = \"face\"\n",
       {"surface.temperature", "terms.conduction = true"}},
      {"recoil of faces without vapour",
       added(weld, "terms", "recoil = true") + "[surface]\ntemperature = \"face\"\n",
       {"surface.temperature", "terms.evaporation = true"}},
      {"faces that lose nothing",
       flat + "[surface]\ntemperature = \"face\"\n",
       {"surface.temperature", "terms.evaporation"}},
      {"buoyancy without gravity",
       added(added(weld, "terms", "buoyancy = true"), "domain", "gravity_m_s2 = 0"),
       {"terms.buoyancy: found true without effect", "domain.gravity_m_s2 > 0"}},
      {"gravity that nothing uses",
       added(flat, "domain", "gravity_m_s2 = 1.6"),
       {"domain.gravity_m_s2", "terms.gravity or terms.buoyancy"}},
      {"interface viscosity without a speed",
       added(weld, "terms", "interface_viscosity = true"),
       {"flow.reference_speed_m_s: found 0"}},
      {"jitter of a lattice",
       added(weld, "domain", "jitter = 0.1"),
       {"domain.jitter", "domain.arrangement = \"jittered\""}},
      {"tilt of an upright beam",
       added(weld, "laser", "tilt = \"trailing\""),
       {"laser.tilt", "laser.incidence_deg > 0"}},
      {"corner of a ball",
       replaced(weld, "shape = \"box\"",
                "shape = \"ball\"\ncenter_m = [5e-4, 0, -4e-4]\nradii_m = [2e-4, 2e-4, 2e-4]"),
       {"bodies.0.min_m", "shape = \"box\""}},
      {"face in y of a plane",
       flat + "[faces.y_min]\nkind = \"wall\"\n",
       {"faces.y_min.kind", "domain.dimension = 3"}},
      {"hot face without conduction",
       replaced(added(weld, "faces.z_min", "thermal = \"flux\"\nflux_w_m2 = 1e6"), "conduction = true\n", ""),
       {"faces.z_min.thermal", "terms.conduction"}},
      {"temperature of a free face",
       faced("[faces.z_min]\nthermal = \"temperature\"\ntemperature_k = 300\n"),
       {"a.toml:9: faces.z_min.thermal", "on a free face"}},
      {"period of a plane",
       flat + "[faces.z_max]\nkind = \"periodic\"\n",
       {"a.toml:24: faces.z_max.kind", "faces.z_min.kind as well"}},
      {"no term", replaced(flat, "conduction = true\n", ""), {"terms: found no term that acts"}},
  });
}

TEST_CASE("case file: terms that nothing flows by") {
  const std::string heat = added(flat, "terms", "recoil = true\nevaporation = true");
  all_refused({
      {"recoil without pressure",
       heat + "[heat]\ninitial_temperature_k = 2500\n",
       {"a.toml:16: terms.recoil: found true without effect: terms.pressure is off"}},
      {"gravity without pressure",
       added(flat, "terms", "gravity = true"),
       {"terms.gravity", "terms.pressure = true with it"}},
      {"pressure where nothing melts",
       replaced(weld, "melting = true", "melting = false"),
       {"terms.pressure: found true without effect: nothing is liquid and nothing melts"}},
  });
  // Switched off later, on purpose.
  CHECK(message({"", weld, {}, {"terms.pressure=false"}}) == "(accepted)");
  CHECK(message({"", weld, {}, {"terms.melting=false"}}) == "(accepted)");
  // So does the resolved case of such a run, which gives all keys in one layer.
  for (const std::string set : {"terms.pressure=false", "terms.melting=false"}) {
    const std::string resolved = meltray::scene::write_case(read_case_text(weld, "a.toml", {set}));
    CHECK(message({"", resolved, {}}) == "(accepted)");
  }
}

TEST_CASE("case file: properties that leave their range over temperature") {
  const auto conductivity = [](const std::string& table) {
    return added(weld, "material", "conductivity_liquid_w_m_k = " + table);
  };
  all_refused({
      {"falls below zero at max_k",
       conductivity("{form=\"linear\", value=30, slope=-0.05, reference_k=1800, min_k=1800, max_k=3000}"),
       {"a.toml:17: material.conductivity_liquid_w_m_k: found -30 at 3000 K", "allowed values > 0"}},
      {"without an end",
       conductivity("{form=\"linear\", value=30, slope=-0.01, reference_k=1800}"),
       {"found -52 at 10000 K"}},
  });
  const std::string held = "{form=\"linear\", value=30, slope=-0.01, reference_k=1800, max_k=3000}";
  CHECK(message({"", conductivity(held), {}}) == "(accepted)");
  // Surface tension has a floor.
  CHECK(message({"",
                 added(weld, "material",
                       "surface_tension_n_m = {form=\"linear\", value=1.8, slope=-4e-4, reference_k=1811}"),
                 {}}) == "(accepted)");
}

TEST_CASE("case file: what a scene cannot do") {
  const std::string wall = "[faces.x_min]\nkind = \"wall\"\nthermal = \"flux\"\nflux_w_m2 = 1e6\n";
  all_refused({
      {"vapour of nothing",
       added(added(weld, "terms", "evaporation = true"), "material", "molar_mass_kg_mol = 0"),
       {"a.toml:17: material.molar_mass_kg_mol: found 0 with terms.evaporation"}},
      {"molar mass in grams",
       added(weld, "material", "molar_mass_kg_mol = 55.8"),
       {"material.molar_mass_kg_mol: found 55.8; allowed a number from 0 to 1 [kg/mol]"}},
      {"flux into cold solid that sleeps",
       flat + wall + "[heat]\nbulk_interval_s = 1e-5\n",
       {"heat.bulk_interval_s: found 1e-05 s with a face that heats or cools (faces.x_min.thermal)"}},
      {"implicit flow",
       added(weld, "time", "method = \"implicit\""),
       {"time.method: found \"implicit\" with terms.pressure"}},
      {"steps longer than the case",
       added(weld, "time", "min_step_s = 1"),
       {"time.min_step_s: found 1; allowed less than time.end_s"}},
      {"a row with buoyancy for a metal without expansion",
       "model = \"isph\"\n" + replaced(weld, "\"iron\"", "\"ss316\""),
       {"a.toml:1: model: found \"isph\", a row with buoyancy", "terms.buoyancy = false with it"}},
  });
}

TEST_CASE("case file: a row or a material over a resolved case") {
  const std::string resolved = meltray::scene::write_case(read_case_text(weld, "a.toml"));
  for (const std::string set : {"model=\"wcsph\"", "material.name=\"aluminium\""}) {
    const std::string what = message({"", resolved, {}, {set}});
    INFO(what);
    CHECK(what.find("over a resolved case") != std::string::npos);
  }
  CHECK(message({"", resolved, {}, {"laser.power_w=900"}}) == "(accepted)");
}
