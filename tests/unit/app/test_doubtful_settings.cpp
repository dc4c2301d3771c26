// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "app/doubtful_settings.hpp"

using namespace meltray;
using namespace meltray::app;

TEST_CASE("settings of a weld that are hardly meant are named") {
  scene::Scene s;
  s.domain.spacing = 5e-5;
  s.domain.max = Vec3(2e-3, 1e-3, 1e-3);
  s.domain.bodies.resize(1);
  s.domain.bodies[0].max = Vec3(2e-3, 1e-3, 0);
  s.time.end = 1e-3;
  s.material = material_by_name("iron");
  CHECK(doubtful_settings(s).empty());
  s.laser.emplace();
  s.laser->beam.feed = 1;
  CHECK(doubtful_settings(s).empty());
  s.laser->beam.start_x = 1.5e-3;
  REQUIRE(doubtful_settings(s).size() == 1);
  CHECK(doubtful_settings(s)[0].starts_with("the beam leaves the bodies"));
  s.laser->beam.off_time = 4e-4;
  CHECK(doubtful_settings(s).empty());
  s.material.density = 7.8;
  REQUIRE(doubtful_settings(s).size() == 1);
  CHECK(doubtful_settings(s)[0].starts_with("material.density_kg_m3: 7.8"));
  s.material.density = 7800;
  s.domain.bodies[0].max[2] = s.domain.max[2];
  CHECK(doubtful_settings(s).size() == 2);  // top above z = 0, no head room
}

TEST_CASE("boxes whose faces lie between two layers of the lattice are named") {
  scene::Scene s;
  s.domain.spacing = 15e-6;
  s.domain.min = Vec3(0, -0.3e-3, -0.7e-3);
  s.domain.max = Vec3(0.9e-3, 0.3e-3, 0.2e-3);
  s.domain.bodies.resize(1);
  s.domain.bodies[0].min = s.domain.min;
  s.domain.bodies[0].max = Vec3(0.9e-3, 0.3e-3, 0);  // 46.7 layers of a height of 60
  REQUIRE(doubtful_settings(s).size() == 1);
  CHECK(doubtful_settings(s)[0].starts_with("bodies[0].max_m: z = 0 m lies between two layers"));
  CHECK(doubtful_settings(s)[0].ends_with("they end at 5e-06 m"));
  SECTION("not where layers end there") {
    s.domain.min[2] = s.domain.bodies[0].min[2] = -0.705e-3;
    s.domain.max[2] = 0.195e-3;
  }
  SECTION("not where they nearly do") {
    s.domain.bodies[0].max[2] = 4e-6;
  }
  SECTION("not of faces that the box cuts off") {
    s.domain.bodies[0].max[2] = 1;
  }
  SECTION("not of other shapes") {
    s.domain.bodies[0].shape = scene::ShapeKind::ball;
  }
  SECTION("not of lattices that are turned") {
    s.domain.arrangement = scene::Arrangement::rotated;
  }
  CHECK(doubtful_settings(s).empty());
}
