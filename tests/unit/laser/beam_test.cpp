// SPDX-License-Identifier: MIT
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "meltray/core/constants.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/laser/beam.hpp"

using namespace meltray;
using namespace meltray::laser;

namespace {

BeamSpec paper_beam() {
  BeamSpec s;
  s.modulation = Modulation::sine;
  s.power = 2250;
  s.amplitude = 1750;
  s.frequency = 100;
  s.incidence_deg = 10;
  s.feed = 4.0 / 60;
  s.start_x = 1e-3;
  s.start_y = 2e-4;
  s.focus_z = -1e-4;
  return s;
}

/// Point of a ray on the plane through `point` across `axis`.
Vec3 on_plane(const Ray& ray, const Vec3& point, const Vec3& axis) {
  return ray.origin + ray.direction * ((point - ray.origin).dot(axis) / ray.direction.dot(axis));
}

}  // namespace

TEST_CASE("beam power over time") {
  BeamSpec s = paper_beam();
  s.on_time = 1e-4;
  s.off_time = 0.02;
  const Beam sine(s);
  CHECK(sine.power(0.0025) == Approx(4000));
  CHECK(sine.power(0.0075) == Approx(500));
  CHECK(sine.power(0) == 0);
  CHECK(sine.power(0.02) == 0);
  s.amplitude = 5000;  // a laser does not draw power
  CHECK(Beam(s).power(0.0075) == 0);

  s.modulation = Modulation::constant;
  CHECK(Beam(s).power(0.0075) == 2250);

  s.modulation = Modulation::table;
  s.on_time = -1;
  s.table = {{0.0, 100}, {1e-3, 300}, {2e-3, 0}};
  const Beam table(s);
  CHECK(table.power(-0.5) == 100);
  CHECK(table.power(5e-4) == Approx(200));
  CHECK(table.power(1e-3) == Approx(300));
  CHECK(table.power(1.5e-3) == Approx(150));
  CHECK(table.power(1) == 0);
}

TEST_CASE("beam axis tilts along the feed when leading") {
  BeamSpec s = paper_beam();
  const double angle = 10 * constants::pi / 180;
  CHECK((Beam(s).axis() - Vec3(std::sin(angle), 0, -std::cos(angle))).norm() < 1e-15);
  s.tilt = Tilt::trailing;
  CHECK((Beam(s).axis() - Vec3(-std::sin(angle), 0, -std::cos(angle))).norm() < 1e-15);
  CHECK((Beam(s).focus(0.03) - Vec3(3e-3, 2e-4, -1e-4)).norm() < 1e-15);
}

TEST_CASE("gaussian rays carry the power and the moments of the beam") {
  const Beam beam(paper_beam());
  const double t = 0.0125, w = 1e-4;
  const int n = 2000;
  const auto rays = beam.rays(t, n, 5e-4);
  REQUIRE(rays.size() == static_cast<std::size_t>(n));
  const Vec3 axis = beam.axis(), focus = beam.focus(t);
  const Vec3 e1(-axis.z(), 0, axis.x()), e2 = Vec3::UnitY();
  double power = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0, within_w = 0;
  for (const Ray& r : rays) {
    CHECK(r.origin.z() == Approx(5e-4));
    CHECK(r.direction.norm() == Approx(1).epsilon(1e-14));
    CHECK((r.direction - axis).norm() < 1e-12);
    const Vec3 p = on_plane(r, focus, axis) - focus;
    const double a = p.dot(e1), b = p.dot(e2);
    power += r.power;
    x += a / n, y += b / n, xx += a * a / n, yy += b * b / n, xy += a * b / n;
    within_w += (std::hypot(a, b) < w ? 1.0 : 0.0) / n;
  }
  CHECK(power == Approx(beam.power(t)).epsilon(1e-12));
  CHECK(std::hypot(x, y) < 2e-3 * w);
  // Second moment of exp(-2 r^2/w^2) cut at 2.5 w: w^2/4 (1 - 12.5 e^-12.5/(1 - e^-12.5)).
  const double cut = std::exp(-12.5), moment = 0.25 * w * w * (1 - 12.5 * cut / (1 - cut));
  CHECK(xx == Approx(moment).epsilon(5e-3));
  CHECK(yy == Approx(moment).epsilon(5e-3));
  CHECK(std::abs(xy) < 5e-3 * moment);
  CHECK(within_w == Approx((1 - std::exp(-2)) / (1 - cut)).margin(1.0 / n));
}

TEST_CASE("sets of few rays lie at other places and make up one of many") {
  BeamSpec s = paper_beam();
  s.incidence_deg = 0;
  const Beam beam(s);
  constexpr int kSets = 64, kRays = 50, kSectors = 12;
  const Vec3 focus = beam.focus(0);
  std::array<double, kSectors> sector{};
  double inner = 0;
  std::vector<Vec3> first;
  for (int set = 0; set < kSets; ++set) {
    const auto rays = beam.rays(0, kRays, focus.z(), set);
    double power = 0;
    for (const Ray& r : rays) {
      const Vec3 p = r.origin - focus;
      const double turn = std::atan2(p.y(), p.x()) / (2 * constants::pi) + 0.5;
      sector[static_cast<std::size_t>(turn * kSectors) % kSectors] += 1.0 / (kSets * kRays);
      inner += (p.norm() < 2e-5 ? 1.0 : 0.0) / (kSets * kRays);
      power += r.power;
    }
    CHECK(power == Approx(beam.power(0)).epsilon(1e-12));
    first.push_back(rays[7].origin);
  }
  for (const double share : sector) CHECK(share == Approx(1.0 / kSectors).epsilon(0.02));
  // 1 - exp(-2 (r/w)^2) within a fifth of the radius at 1/e^2: four rays of fifty.
  CHECK(inner == Approx(-std::expm1(-0.08) / -std::expm1(-12.5)).epsilon(0.02));
  for (std::size_t k = 1; k < first.size(); ++k) CHECK((first[k] - first[0]).norm() > 1e-7);
}

TEST_CASE("top-hat rays fill the disc evenly") {
  BeamSpec s = paper_beam();
  s.profile = Profile::top_hat;
  s.incidence_deg = 0;
  const Beam beam(s);
  const auto rays = beam.rays(0, 1000, 0.0);
  const Vec3 focus = beam.focus(0);
  double rr = 0, largest = 0, x = 0, y = 0;
  for (const Ray& r : rays) {
    const Vec3 p = r.origin - focus;
    const double rho = std::hypot(p.x(), p.y());
    rr += rho * rho / 1000;
    x += p.x() / 1000, y += p.y() / 1000;
    largest = std::max(largest, rho);
  }
  CHECK(rr == Approx(0.5e-8).epsilon(1e-3));
  CHECK(largest <= 1e-4);
  CHECK(largest > 0.999e-4);
  CHECK(std::hypot(x, y) < 2e-7);
}

TEST_CASE("divergent rays widen as the hyperbola of the beam") {
  BeamSpec s = paper_beam();
  s.rayleigh_length = 2e-3;
  const Beam beam(s);
  CHECK(beam.radius(0) == Approx(1e-4));
  CHECK(beam.radius(2e-3) == Approx(std::sqrt(2.0) * 1e-4));
  const auto rays = beam.rays(0, 1000, 3e-3);
  const Vec3 axis = beam.axis(), focus = beam.focus(0);
  for (const double distance : {-2e-3, 0.0, 1e-3, 4e-3}) {
    const Vec3 centre = focus + distance * axis;
    double rr = 0;
    Vec3 swirl = Vec3::Zero();
    for (const Ray& r : rays) {
      const Vec3 p = on_plane(r, centre, axis) - centre;
      rr += p.squaredNorm() / 1000;
      swirl += p.cross(r.direction) / 1000;
    }
    CAPTURE(distance);
    // Half the square of the 1/e^2 radius, less the cut tail (12.5 e^-12.5, under 5e-5).
    CHECK(rr == Approx(0.5 * std::pow(beam.radius(distance), 2)).epsilon(2e-3));
    CHECK(std::abs(swirl.dot(axis)) < 0.01 * 1e-4 * 1e-4 / 2e-3);
  }
}

TEST_CASE("the axis bundle surrounds the axis at a quarter of the focal radius") {
  const Beam beam(paper_beam());
  const auto bundle = beam.axis_bundle(0, 1e-3);
  REQUIRE(bundle.size() > 4);
  const Vec3 focus = beam.focus(0), axis = beam.axis();
  CHECK((on_plane(bundle[0], focus, axis) - focus).norm() < 1e-12);
  for (std::size_t i = 1; i < bundle.size(); ++i)
    CHECK((on_plane(bundle[i], focus, axis) - focus).norm() == Approx(0.25e-4));
  for (const Ray& r : bundle) {
    CHECK(r.power == 0);
    CHECK(r.origin.z() == Approx(1e-3));
  }
}

TEST_CASE("impossible beams are refused") {
  BeamSpec s = paper_beam();
  s.focal_diameter = 0;
  CHECK_THROWS_AS(Beam(s), UsageError);
  s = paper_beam();
  s.incidence_deg = 90;
  CHECK_THROWS_AS(Beam(s), UsageError);
  s = paper_beam();
  s.modulation = Modulation::table;
  CHECK_THROWS_AS(Beam(s), UsageError);
  s.table = {{1.0, 1.0}, {1.0, 2.0}};
  CHECK_THROWS_AS(Beam(s), UsageError);
}
