// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "app/known_limits.hpp"

using namespace meltray;
using namespace meltray::app;

TEST_CASE("the usual settings are within the known limits") {
  scene::Scene s;
  s.terms.interface_viscosity = s.terms.buoyancy = true;
  CHECK(beyond_known_limits(s).empty());
  s.laser.emplace();
  CHECK(beyond_known_limits(s).empty());
}

TEST_CASE("long steps are named, earlier for a weld than for a pool, and earliest without tension") {
  scene::Scene s;
  s.time.cfl_advective *= 3;
  REQUIRE(beyond_known_limits(s).size() == 1);
  CHECK(beyond_known_limits(s)[0].starts_with("time.cfl_advective: 3 times"));
  s.terms.surface_tension = true;
  CHECK(beyond_known_limits(s).empty());
  s.time.cfl_capillary *= 6;
  CHECK(beyond_known_limits(s).empty());
  s.laser.emplace();
  REQUIRE(beyond_known_limits(s).size() == 1);
  CHECK(beyond_known_limits(s)[0].starts_with("time.cfl_capillary: 6 times"));
  s.time.integrator.fixed_step = 1e-6;  // the limits do not act
  CHECK(beyond_known_limits(s).empty());
  s.laser.reset();
  s.time.integrator.fixed_step = 0;
  s.time.cfl_capillary *= 2;
  CHECK(beyond_known_limits(s).size() == 1);
}

TEST_CASE("light that may heat a particle far in one step is named") {
  scene::Scene s;
  s.laser.emplace();
  s.time.laser_heating *= 5;
  REQUIRE(beyond_known_limits(s).size() == 1);
  CHECK(beyond_known_limits(s)[0].starts_with("time.laser_heating_k: 5 times"));
}

TEST_CASE("stiff interfaces under the projection in every stage are named") {
  scene::Scene s;
  s.terms.interface_viscosity = true;
  s.flow.interface_viscosity_solid = 500;
  CHECK(beyond_known_limits(s).empty());
  s.flow.projection = scene::Projection::stage;
  REQUIRE(beyond_known_limits(s).size() == 1);
  CHECK(beyond_known_limits(s)[0].starts_with("flow.interface_viscosity_*: 500"));
  s.terms.interface_viscosity = false;
  CHECK(beyond_known_limits(s).empty());
}

TEST_CASE("a weld in elastic solid of nearly its whole modulus is named") {
  scene::Scene s;
  s.terms.pressure = true;
  s.flow.solver = scene::FlowSolver::wcsph;
  s.flow.solid = scene::SolidModel::elastic;
  CHECK(beyond_known_limits(s).empty());
  s.laser.emplace();
  REQUIRE(beyond_known_limits(s).size() == 1);
  CHECK(beyond_known_limits(s)[0].starts_with("flow.elastic_modulus_scale: 1 in a weld"));
  s.flow.elastic_modulus_scale = 1e-4;
  CHECK(beyond_known_limits(s).empty());
}

TEST_CASE("an interface viscosity that does not go with the temperature of the surface is named") {
  scene::Scene s;
  s.terms.recoil = s.terms.interface_viscosity = true;
  s.laser.emplace();
  CHECK(beyond_known_limits(s).empty());
  s.surface.temperature = scene::SurfaceTemperature::face;
  REQUIRE(beyond_known_limits(s).size() == 1);
  CHECK(beyond_known_limits(s)[0].starts_with("flow.interface_viscosity_*: 1 with surface.temperature"));
  s.flow.interface_viscosity_free = s.flow.interface_viscosity_solid = 0.1;
  CHECK(beyond_known_limits(s).empty());
  s.surface.temperature = scene::SurfaceTemperature::particle;
  REQUIRE(beyond_known_limits(s).size() == 1);
  CHECK(beyond_known_limits(s)[0].starts_with("flow.interface_viscosity_*: 0.1 with surface.temperature"));
  s.terms.recoil = false;
  CHECK(beyond_known_limits(s).empty());
}

TEST_CASE("the repulsion of stretched melt is named where vapour pushes weakly compressible melt") {
  scene::Scene s;
  s.flow.solver = scene::FlowSolver::wcsph;
  s.flow.tension = scene::Tension::artificial_stress;
  CHECK(beyond_known_limits(s).empty());
  s.terms.recoil = true;
  REQUIRE(beyond_known_limits(s).size() == 1);
  CHECK(beyond_known_limits(s)[0].starts_with("flow.tension: \"artificial_stress\""));
  s.flow.tension = scene::Scene().flow.tension;
  CHECK(beyond_known_limits(s).empty());
}

TEST_CASE("a full box of walls that looks for a free surface is named") {
  scene::Scene s;
  s.terms.pressure = true;
  s.domain.dimension = 2;
  s.domain.max = Vec3(1, 1, 0);
  for (const std::size_t f : {0, 1, 4, 5}) s.domain.faces[f].kind = scene::FaceKind::wall;
  s.domain.bodies.push_back({.min = Vec3::Zero(), .max = Vec3(1, 1, 0)});
  REQUIRE(beyond_known_limits(s).size() == 1);
  CHECK(beyond_known_limits(s)[0].starts_with("flow.free_surface"));
  SECTION("not where it does not") {
    s.flow.free_surface = false;
    s.flow.shifting = 4;
    s.flow.shifting_speed = 0.1;
  }
  SECTION("not where the body leaves room") {
    s.domain.bodies[0].max[1] = 0.9;
  }
  SECTION("not where the box is open") {
    s.domain.faces[5].kind = scene::FaceKind::free;
  }
  CHECK(beyond_known_limits(s).empty());
}

TEST_CASE("a full box whose particles are not shifted, or not where they rest, is named") {
  scene::Scene s;
  s.terms.pressure = true;
  s.flow.free_surface = false;
  REQUIRE(beyond_known_limits(s).size() == 1);
  CHECK(beyond_known_limits(s)[0].starts_with("flow.shifting:"));
  s.flow.shifting = 4;
  REQUIRE(beyond_known_limits(s).size() == 1);
  CHECK(beyond_known_limits(s)[0].starts_with("flow.shifting_speed_m_s:"));
  s.flow.shifting_speed = 0.1;
  CHECK(beyond_known_limits(s).empty());
}
