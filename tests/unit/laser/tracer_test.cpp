// SPDX-License-Identifier: MIT
#include "meltray/laser/laser.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "meltray/core/constants.hpp"
#include "meltray/core/parallel.hpp"
#include "unit/laser/facets.hpp"

using namespace meltray;
using namespace meltray::laser;
using namespace meltray::laser::testing;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegree = constants::pi / 180;

void check_closed(const Ledger& l) {
  const double out = l.absorbed + l.escaped + l.residual + l.dropped;
  CHECK(std::abs(out - l.in) <= 1e-12 * l.in);
}

double power_of(const std::vector<Hit>& hits) {
  double sum = 0;
  for (const Hit& h : hits) sum += h.power;
  return sum;
}

/// Axis-parallel rays that fill the opening of a wedge evenly.
std::vector<Ray> down_into_wedge(double half_angle, int count) {
  const double half_width = std::sin(half_angle) * 1e-3;
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const double x = half_width * (2 * (i + 0.5) / count - 1);
    rays.push_back({{x, 1.1e-4, 2e-3}, {0, 0, -1}, 1.0 / count});
  }
  return rays;
}

double absorbed_in_wedge(double half_angle, const TraceOptions& options) {
  Tracer tracer;
  tracer.set_mesh(wedge(half_angle));
  const Trace trace = tracer.trace(down_into_wedge(half_angle, 2000), options);
  check_closed(trace.ledger);
  CHECK(trace.ledger.residual < 1e-4);
  return trace.ledger.absorbed;
}

std::vector<Ray> slanted_rays(int count) {
  BeamSpec s;
  s.power = 1000;
  s.incidence_deg = 10;
  return Beam(s).rays(0, count, 1e-3);
}

}  // namespace

TEST_CASE("a beam at 10 degrees on a flat plate leaves Fresnel's share") {
  Tracer tracer;
  tracer.set_mesh(plate(1e-2));
  for (const auto mode : {Polarisation::averaged, Polarisation::tracked}) {
    TraceOptions options;
    options.index_solid = {2.927, 4.377};
    options.polarisation = mode;
    options.polarisation_xy = {0, 0};
    const Trace trace = tracer.trace(slanted_rays(500), options);
    check_closed(trace.ledger);
    CHECK(trace.ledger.bounces == 500);
    CHECK(trace.ledger.absorbed == Approx(1000 * absorptance({2.927, 4.377}, std::cos(10 * kDegree))));
    CHECK(power_of(trace.hits) == Approx(trace.ledger.absorbed));
  }
}

TEST_CASE("wedge_absorption on exact facets, averaged per bounce") {
  struct Row {
    double degrees, fe, al;
  };
  for (const Row& r : {Row{45, 0.57306, 0.11059}, Row{30, 0.73468, 0.17364}, Row{22.5, 0.83454, 0.23526},
                       Row{15, 0.93330, 0.34711}, Row{5, 0.99959, 0.72869}}) {
    CAPTURE(r.degrees);
    TraceOptions options;
    options.index_solid = {2.927, 4.377};
    CHECK(absorbed_in_wedge(r.degrees * kDegree, options) == Approx(r.fe).margin(1e-3));
    options.index_solid = {1.3998, 9.8914};
    CHECK(absorbed_in_wedge(r.degrees * kDegree, options) == Approx(r.al).margin(1e-3));
  }
}

TEST_CASE("wedge_absorption on exact facets, polarisation tracked") {
  struct Row {
    double degrees, fe, al;
  };
  for (const Row& r : {Row{45, 0.56417, 0.11025}, Row{30, 0.71294, 0.17227}, Row{22.5, 0.80069, 0.23180},
                       Row{15, 0.89236, 0.33669}, Row{5, 0.99557, 0.67008}}) {
    CAPTURE(r.degrees);
    TraceOptions options;
    options.polarisation = Polarisation::tracked;
    for (const bool iron : {true, false}) {
      options.index_solid = iron ? std::complex<double>{2.927, 4.377} : std::complex<double>{1.3998, 9.8914};
      // Unpolarised light, and the mean of light polarised across (p) and along (s) the groove, and light
      // halfway between them: in a groove all three absorb alike.
      const double reference = iron ? r.fe : r.al;
      options.polarisation_xy = {0, 0};
      CHECK(absorbed_in_wedge(r.degrees * kDegree, options) == Approx(reference).margin(1e-3));
      options.polarisation_xy = {1, 0};
      const double p = absorbed_in_wedge(r.degrees * kDegree, options);
      options.polarisation_xy = {0, 1};
      const double s = absorbed_in_wedge(r.degrees * kDegree, options);
      CHECK(0.5 * (s + p) == Approx(reference).margin(1e-3));
      CHECK(p > s);
      options.polarisation_xy = {1, 1};
      CHECK(absorbed_in_wedge(r.degrees * kDegree, options) == Approx(reference).margin(1e-3));
    }
  }
}

TEST_CASE("tracked light out of a plane of incidence: two crossed mirrors") {
  // First mirror at 45 degrees sends -z light along +x; the second, turned about x by an angle, sends it
  // across. The reference multiplies 3-D reflection matrices of the field (Yun et al. 2011, Appl. Opt. 50,
  // 2855).
  const std::complex<double> m{2.927, 4.377};
  const double turn = 35 * kDegree;
  SurfaceMesh mesh;
  const double d = 1e-3;
  add_facet(mesh, {-d, -d, d}, {0, 2 * d, 0}, {2 * d, 0, -2 * d});
  const Vec3 flip = Vec3(-1, std::sin(turn), std::cos(turn)).normalized();
  const Vec3 across = flip.cross(Vec3::UnitY()).normalized() * 6 * d, along = flip.cross(across);
  add_facet(mesh, Vec3(8 * d, 0, 0) - 0.5 * across - 0.5 * along, across, along);
  // Both facets must face the light.
  for (int facet = 0; facet < 2; ++facet) {
    const Vec3 wanted = facet == 0 ? Vec3(1, 0, 1) : flip;
    if (mesh.normals[static_cast<std::size_t>(4 * facet)].dot(wanted) < 0)
      for (int c = 0; c < 4; ++c) mesh.normals[static_cast<std::size_t>(4 * facet + c)] *= -1;
  }
  Tracer tracer;
  tracer.set_mesh(mesh);

  using Field = Eigen::Vector3cd;
  const auto reflect = [&](const Field& e, const Vec3& in, const Vec3& n) {
    const Vec3 out = in - 2 * in.dot(n) * n, s = in.cross(n).normalized();
    const double c = -in.dot(n);
    const std::complex<double> q = std::sqrt(m * m - (1 - c * c));
    const std::complex<double> rs = (c - q) / (c + q), rp = (m * m * c - q) / (m * m * c + q);
    const Field sc = s.cast<std::complex<double>>();
    const Field pi = s.cross(in).cast<std::complex<double>>(), po = s.cross(out).cast<std::complex<double>>();
    return std::pair<Field, Vec3>(rs * sc * sc.dot(e) + rp * po * pi.dot(e), out);
  };
  for (const std::array<double, 2> xy : {std::array{1.0, 0.0}, {0.0, 1.0}, {0.6, 0.8}, {-0.6, 0.8}}) {
    const Vec3 n1 = Vec3(1, 0, 1).normalized();
    Field e0(xy[0], xy[1], 0);
    const auto [e1, d1] = reflect(e0, -Vec3::UnitZ(), n1);
    const auto [e2, d2] = reflect(e1, d1, flip);
    TraceOptions options;
    options.polarisation = Polarisation::tracked;
    options.polarisation_xy = xy;
    options.index_solid = m;
    const Ray ray{{0, 0, 2 * d}, {0, 0, -1}, 1.0};
    const Trace trace = tracer.trace(std::span(&ray, 1), options);
    REQUIRE(trace.hits.size() == 2);
    CHECK(trace.hits[0].power == Approx(1 - e1.squaredNorm()).epsilon(1e-6));
    CHECK(trace.ledger.escaped == Approx(e2.squaredNorm()).epsilon(1e-6));
  }
}

TEST_CASE("the ledger closes whatever the surface absorbs") {
  Tracer tracer;
  tracer.set_mesh(wedge(5 * kDegree));
  TraceOptions options;
  const auto rays = down_into_wedge(5 * kDegree, 500);
  SECTION("everything") {
    options.fixed_absorptance = 1.0;
    const Trace t = tracer.trace(rays, options);
    check_closed(t.ledger);
    CHECK(t.ledger.absorbed == Approx(1));
    CHECK(t.ledger.bounces == 500);
    CHECK(t.hits.size() == 500);
  }
  SECTION("nearly nothing: 18 reflections and out") {
    options.fixed_absorptance = 1e-12;
    const Trace t = tracer.trace(rays, options);
    check_closed(t.ledger);
    CHECK(t.ledger.escaped == Approx(1));
    CHECK(static_cast<double>(t.ledger.bounces) / 500 == Approx(18).margin(0.05));
  }
  SECTION("an end fraction of a half leaves a residual at the last hit") {
    options.fixed_absorptance = 0.3;
    options.end_fraction = 0.5;
    const Trace t = tracer.trace(rays, options);
    check_closed(t.ledger);
    CHECK(t.ledger.absorbed == Approx(0.51).epsilon(1e-3));
    CHECK(t.ledger.residual == Approx(0.49).epsilon(1e-3));
    CHECK(power_of(t.hits) == Approx(t.ledger.absorbed + t.ledger.residual));
  }
  SECTION("the end is relative to the ray's own power") {
    options.fixed_absorptance = 0.3;
    Ray weak = rays[7], strong = rays[7];
    weak.power = 1e-9;
    strong.power = 1e9;
    const Ledger a = tracer.trace(std::span(&weak, 1), options).ledger;
    const Ledger b = tracer.trace(std::span(&strong, 1), options).ledger;
    CHECK(a.bounces == b.bounces);
    CHECK(a.absorbed * 1e18 == Approx(b.absorbed));
  }
}

TEST_CASE("a ray that cannot get out ends at the bounce guard") {
  SurfaceMesh mesh;  // two plates that face each other
  add_facet(mesh, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  add_facet(mesh, {-1, -1, 1}, {0, 2, 0}, {2, 0, 0});
  Tracer tracer;
  tracer.set_mesh(mesh);
  TraceOptions options;
  options.fixed_absorptance = 1e-12;
  const Ray ray{{0.1, 0.2, 0.5}, {0, 0, -1}, 3};
  const Trace t = tracer.trace(std::span(&ray, 1), options);
  check_closed(t.ledger);
  CHECK(t.ledger.bounces == 1000);
  CHECK(t.ledger.residual == Approx(3));
  CHECK(t.ledger.absorbed == Approx(3e-9).epsilon(1e-3));
  CHECK(t.hits.size() == 1001);  // far more than are kept in the first go
  CHECK(power_of(t.hits) == Approx(3).epsilon(1e-12));
}

TEST_CASE("an empty mesh lets every ray escape") {
  Tracer tracer;
  TraceOptions options;
  for (int pass = 0; pass < 2; ++pass) {
    const Ledger l = tracer.trace(slanted_rays(10), options).ledger;
    CHECK(l.escaped == Approx(1000));
    CHECK(l.bounces == 0);
    tracer.set_mesh({});
  }
  tracer.set_mesh(plate(1e-2));
  CHECK(tracer.trace(slanted_rays(10), options).ledger.bounces == 10);
  tracer.set_mesh({});
  CHECK(tracer.trace(slanted_rays(10), options).ledger.bounces == 0);
  CHECK_FALSE(tracer.first_hit({{0, 0, 1}, {0, 0, -1}, 1}));
}

TEST_CASE("rays that are not finite are dropped and counted") {
  Tracer tracer;
  tracer.set_mesh(plate(1e-2));
  TraceOptions options;
  options.fixed_absorptance = 0.5;
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<Ray> rays = {{{0, 0, 1}, {0, 0, -1}, 1},     {{kNan, 0, 1}, {0, 0, -1}, 2},
                                 {{0, 0, 1}, {0, kNan, -1}, 4},  {{0, 0, 1}, {0, 0, 0}, 8},
                                 {{0, 0, 1}, {0, 0, -inf}, 16},  {{0, 0, 1}, {0, 0, -1}, kNan},
                                 {{1e300, 0, 1}, {0, 0, -1}, 32}};
  const Ledger l = tracer.trace(rays, options).ledger;
  check_closed(l);
  CHECK(l.rays == 7);
  CHECK(l.dropped_rays == 5);
  CHECK(l.dropped == Approx(30));
  CHECK(l.absorbed == Approx(0.5));
  CHECK(l.escaped == Approx(32.5));
  CHECK_FALSE(tracer.first_hit(rays[1]));
}

TEST_CASE("degenerate and broken triangles are not handed on") {
  SurfaceMesh mesh = plate(1e-2);
  mesh.vertices.insert(mesh.vertices.end(),
                       {{0, 0, 1e-3}, {1e-3, 0, 1e-3}, {2e-3, 0, 1e-3}, {kNan, 0, 1e-3}});
  mesh.normals.insert(mesh.normals.end(), 4, Vec3::UnitZ());
  mesh.liquid.insert(mesh.liquid.end(), 4, 0);
  mesh.triangles.insert(mesh.triangles.end(), {{4, 5, 6}, {4, 4, 4}, {4, 5, 7}, {4, 5, 99}});
  Tracer tracer;
  tracer.set_mesh(mesh);
  CHECK(tracer.mesh().triangles.size() == 2);
  const auto hit = tracer.first_hit({{1e-3, 0, 1}, {0, 0, -1}, 1});
  REQUIRE(hit);
  CHECK((*hit - Vec3(1e-3, 0, 0)).norm() < 1e-9);
}

TEST_CASE("a ray from behind the surface is absorbed by the metal") {
  Tracer tracer;
  tracer.set_mesh(plate(1e-2));
  const Ray ray{{0, 0, -1e-3}, {0, 0, 1}, 5};
  const Ledger l = tracer.trace(std::span(&ray, 1), {}).ledger;
  CHECK(l.absorbed == 5);
  check_closed(l);
}

TEST_CASE("liquid and solid metal have their own index") {
  SurfaceMesh mesh = plate(1e-2);
  mesh.liquid.assign(mesh.liquid.size(), 1);
  Tracer tracer;
  tracer.set_mesh(mesh);
  TraceOptions options;
  options.index_solid = {1.0, 9.0};
  options.index_liquid = {3.0, 4.0};
  const Ray ray{{0, 0, 1e-3}, {0, 0, -1}, 1};
  CHECK(tracer.trace(std::span(&ray, 1), options).ledger.absorbed == Approx(absorptance({3.0, 4.0}, 1)));
}

TEST_CASE("smooth normals steer the reflected ray, unless it would enter the metal") {
  SurfaceMesh mesh = plate(1e-2);
  const double lean = 10 * kDegree;
  for (Vec3& n : mesh.normals) n = Vec3(std::sin(lean), 0, std::cos(lean));
  add_facet(mesh, {-1e-2, -1e-2, 2e-3}, {0, 2e-2, 0}, {2e-2, 0, 0});  // a ceiling to be hit
  Tracer tracer;
  tracer.set_mesh(mesh);
  TraceOptions options;
  options.fixed_absorptance = 0.5;
  options.max_bounces = 2;
  const Ray steep{{0, 0, 1e-3}, {0, 0, -1}, 1};
  const Trace a = tracer.trace(std::span(&steep, 1), options);
  REQUIRE(a.hits.size() >= 2);
  CHECK(a.hits[1].position.x() == Approx(2e-3 * std::tan(2 * lean)).epsilon(1e-4));
  // Grazing light along +x, 5 degrees above the plate: the smooth normal faces away by 5 degrees.
  const double graze = 5 * kDegree;
  const Ray shallow{{-5e-3, 0, 5e-3 * std::tan(graze)}, {std::cos(graze), 0, -std::sin(graze)}, 1};
  const Trace b = tracer.trace(std::span(&shallow, 1), options);
  check_closed(b.ledger);
  CHECK(b.ledger.bounces == 1);
  CHECK(b.ledger.escaped == Approx(0.5));
}

TEST_CASE("diffuse reflection follows Lambert's law: parallel discs") {
  // A small beam on the middle of a white plate lights a coaxial disc of radius R at distance h with the
  // share R^2/(R^2 + h^2) of what it sends back.
  SurfaceMesh mesh = plate(1.0);
  const double h = 1e-3, radius = 1.5e-3;
  const int sides = 256;
  const auto centre = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.push_back({0, 0, h});
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * constants::pi * i / sides;
    mesh.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), h});
    mesh.triangles.push_back({centre, centre + 1 + (i + 1) % sides, centre + 1 + i});
  }
  mesh.normals.resize(mesh.vertices.size(), -Vec3::UnitZ());
  mesh.liquid.resize(mesh.vertices.size(), 0);
  Tracer tracer;
  tracer.set_mesh(mesh);
  TraceOptions options;
  options.diffuse = true;
  options.fixed_absorptance = 0.0;
  options.max_bounces = 2;
  const int n = 40000;
  const std::vector<Ray> rays(n, Ray{{1e-6, 0, 0.5 * h}, {0, 0, -1}, 1.0 / n});
  const Ledger l = tracer.trace(rays, options).ledger;
  check_closed(l);
  const double share = radius * radius / (radius * radius + h * h);
  CHECK(l.residual == Approx(share).margin(4 * std::sqrt(share * (1 - share) / n)));  // 4 standard errors
}

TEST_CASE("the trace does not depend on the number of threads") {
  const int before = threads();
  Tracer tracer;
  tracer.set_mesh(wedge(7 * kDegree));
  for (const bool diffuse : {false, true}) {
    TraceOptions options;
    options.index_solid = {2.927, 4.377};
    options.polarisation = Polarisation::tracked;
    options.diffuse = diffuse;
    const auto rays = down_into_wedge(7 * kDegree, 5000);
    set_threads(1);
    const Trace one = tracer.trace(rays, options);
    set_threads(2);
    const Trace two = tracer.trace(rays, options);
    CHECK(one.ledger.absorbed == two.ledger.absorbed);
    REQUIRE(one.hits.size() == two.hits.size());
    bool same = true;
    for (std::size_t i = 0; i < one.hits.size(); ++i)
      same &= one.hits[i].power == two.hits[i].power && one.hits[i].position == two.hits[i].position;
    CHECK(same);
  }
  set_threads(before);
}
