// SPDX-License-Identifier: MIT
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "meltray/core/constants.hpp"
#include "meltray/core/parallel.hpp"
#include "meltray/laser/laser.hpp"

using namespace meltray;
using namespace meltray::laser;

namespace {

constexpr double kDx = 5e-5;
constexpr double kDegree = constants::pi / 180;

struct Metal {
  Components x;
  std::vector<std::uint8_t> liquid;
  PointCloud cloud() const { return {view(x), liquid.size(), liquid.data(), kDx}; }
  void add(const Vec3& p, bool molten = false) {
    for (std::size_t a = 0; a < 3; ++a) x[a].push_back(p[static_cast<int>(a)]);
    liquid.push_back(molten);
  }
};

/// Lattice of cubic cells in a box, the box being a whole number of spacings; `inside` picks particles.
Metal lattice(const Box& box, const std::function<bool(const Vec3&)>& inside, double jitter = 0) {
  Metal m;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-jitter * kDx, jitter * kDx);
  const Vec3 n = ((box.max - box.min) / kDx).array().round();
  for (int k = 0; k < static_cast<int>(n.z()); ++k)
    for (int j = 0; j < static_cast<int>(n.y()); ++j)
      for (int i = 0; i < static_cast<int>(n.x()); ++i) {
        const Vec3 p = box.min + kDx * Vec3(i + 0.5, j + 0.5, k + 0.5);
        if (inside(p)) m.add(p + Vec3(shift(random), shift(random), shift(random)));
      }
  return m;
}

bool everywhere(const Vec3&) {
  return true;
}

struct Roughness {
  double mean = 0, worst = 0, mean_degrees = 0, worst_degrees = 0;  // heights in spacings
};

/// Distance of vertices to the plane through `point` with a normal, and angle of their normals to it.
Roughness roughness(const SurfaceMesh& mesh, const Vec3& point, const Vec3& normal) {
  Roughness r;
  const auto n = static_cast<double>(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const double height = (mesh.vertices[v] - point).dot(normal) / kDx;
    const double angle = std::acos(std::clamp(mesh.normals[v].dot(normal), -1.0, 1.0)) / kDegree;
    r.mean += height / n;
    r.worst = std::max(r.worst, std::abs(height));
    r.mean_degrees += angle / n;
    r.worst_degrees = std::max(r.worst_degrees, angle);
  }
  return r;
}

/// Share of a beam at 10 degrees that a surface around the origin absorbs.
double absorbed_share(const SurfaceMesh& mesh) {
  Tracer tracer;
  tracer.set_mesh(mesh);
  BeamSpec s;
  s.power = 1;
  s.incidence_deg = 10;
  TraceOptions options;
  options.index_solid = options.index_liquid = {2.927, 4.377};
  return tracer.trace(Beam(s).rays(0, 2000, 1e-3), options).ledger.absorbed;
}

const double kFlatShare = absorptance({2.927, 4.377}, std::cos(10 * kDegree));

}  // namespace

TEST_CASE("a lattice slab has its surface half a spacing above the top layer") {
  const Box block{{-6e-4, -6e-4, -4e-4}, {6e-4, 6e-4, 0}};
  const Metal m = lattice(block, everywhere);
  // Also where the region's grid does not fit the lattice, and the region cuts through the metal.
  for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(1.3e-5, -2.1e-5, 1.7e-5)}) {
    Metal moved = m;
    for (std::size_t a = 0; a < 3; ++a)
      for (double& x : moved.x[a]) x += shift[static_cast<int>(a)];
    const SurfaceMesh mesh = reconstruct_surface(moved.cloud(), {{-3e-4, -3e-4, -2e-4}, {3e-4, 3e-4, 3e-4}});
    REQUIRE(mesh.triangles.size() >= 2 * 12 * 12);
    const Roughness r = roughness(mesh, shift, Vec3::UnitZ());
    CHECK(r.worst < 0.02);
    CHECK(r.worst_degrees < 1);
    CHECK(absorbed_share(mesh) == Approx(kFlatShare).epsilon(2e-3));
    CHECK(std::none_of(mesh.liquid.begin(), mesh.liquid.end(), [](auto l) { return l != 0; }));
  }
}

TEST_CASE("a jittered slab keeps a smooth flat surface") {
  const Metal m = lattice({{-6e-4, -6e-4, -4e-4}, {6e-4, 6e-4, 0}}, everywhere, 0.15);
  const SurfaceMesh mesh = reconstruct_surface(m.cloud(), {{-4e-4, -4e-4, -2e-4}, {4e-4, 4e-4, 3e-4}});
  const Roughness r = roughness(mesh, Vec3::Zero(), Vec3::UnitZ());
  INFO("worst height " << r.worst << ", angle mean " << r.mean_degrees << " worst " << r.worst_degrees);
  CHECK(std::abs(r.mean) < 0.03);
  CHECK(r.worst < 0.15);
  CHECK(r.mean_degrees < 3);
  CHECK(r.worst_degrees < 8);
  CHECK(absorbed_share(mesh) == Approx(kFlatShare).epsilon(0.01));
}

TEST_CASE("a rotated lattice has the same flat surface") {
  // Cut by a plane, so the top layer is ragged: its surface lies where the volume says.
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.4, Vec3(1, 2, 0.5).normalized()) * Eigen::AngleAxisd(0.9, Vec3::UnitZ()))
          .toRotationMatrix();
  const Metal cube = lattice({{-2e-3, -2e-3, -1e-3}, {2e-3, 2e-3, 1e-3}}, everywhere);
  Metal ragged, tilted;
  for (std::size_t i = 0; i < cube.liquid.size(); ++i) {
    const Vec3 p(cube.x[0][i], cube.x[1][i], cube.x[2][i]);
    const Vec3 q = turn * p;
    if (q.z() < 0 && q.z() > -5e-4 && q.head<2>().cwiseAbs().maxCoeff() < 7e-4) ragged.add(q);
    if (p.z() < 0) tilted.add(q);  // the lattice's own face, seen from a tilted grid
  }
  const Box region{{-4e-4, -4e-4, -3e-4}, {4e-4, 4e-4, 4e-4}};
  const SurfaceMesh rough = reconstruct_surface(ragged.cloud(), region);
  const Roughness a = roughness(rough, Vec3::Zero(), Vec3::UnitZ());
  INFO("ragged: height mean " << a.mean << " worst " << a.worst << ", angle mean " << a.mean_degrees
                              << " worst " << a.worst_degrees);
  CHECK(std::abs(a.mean) < 0.1);
  CHECK(a.worst < 0.45);
  CHECK(absorbed_share(rough) == Approx(kFlatShare).epsilon(0.01));
  const SurfaceMesh slope = reconstruct_surface(tilted.cloud(), region);
  const Roughness b = roughness(slope, Vec3::Zero(), turn.col(2));
  INFO("tilted: height worst " << b.worst << ", angle mean " << b.mean_degrees << " worst "
                               << b.worst_degrees);
  CHECK(b.worst < 0.1);
  CHECK(b.worst_degrees < 2);
}

TEST_CASE("cropped metal is no free surface") {
  // The cloud ends at the sides and the bottom of the region, as it does at the faces of the workpiece.
  const Box block{{-4e-4, -3e-4, -4e-4}, {4e-4, 3e-4, 0}};
  const Metal m = lattice(block, everywhere, 0.1);
  Box region = block;
  region.max.z() = 3e-4;
  const SurfaceMesh mesh = reconstruct_surface(m.cloud(), region);
  const Roughness r = roughness(mesh, Vec3::Zero(), Vec3::UnitZ());
  CHECK(r.worst < 0.15);
  CHECK(r.worst_degrees < 10);
  // Free sides inside the region are surface: a closed block. Smoothing by a Gaussian of variance 20/27 dx^2
  // rounds its edges: the contour Phi(a) Phi(b) = 1/2 cuts 0.8648 * 20/27 dx^2 off a right-angled edge
  // (integral of Phi^-1(1/(2 Phi(a))) over a > 0).
  const SurfaceMesh closed = reconstruct_surface(m.cloud(), {{-1e-3, -1e-3, -1e-3}, {1e-3, 1e-3, 1e-3}});
  double volume = 0;
  for (const auto& t : closed.triangles)
    volume += closed.vertices[static_cast<std::size_t>(t[0])].dot(
                  closed.vertices[static_cast<std::size_t>(t[1])].cross(
                      closed.vertices[static_cast<std::size_t>(t[2])])) /
              6;
  const double sharp = 16 * 12 * 8, edges = 4 * (16 + 12 + 8);
  CHECK(volume / (kDx * kDx * kDx) == Approx(sharp - edges * 0.8648 * 20 / 27).epsilon(0.01));
}

TEST_CASE("a ball has its radius, and normals along it") {
  const double radius = 10 * kDx;
  const Metal m =
      lattice({{-6e-4, -6e-4, -6e-4}, {6e-4, 6e-4, 6e-4}}, [&](const Vec3& p) { return p.norm() < radius; });
  const SurfaceMesh mesh = reconstruct_surface(m.cloud(), {{-1e-3, -1e-3, -1e-3}, {1e-3, 1e-3, 1e-3}});
  double mean = 0, angle = 0, liquid_ok = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    mean += mesh.vertices[v].norm();
    angle += std::acos(std::min(1.0, mesh.normals[v].dot(mesh.vertices[v].normalized()))) / kDegree;
    liquid_ok += mesh.liquid[v] == 0;
  }
  const auto n = static_cast<double>(mesh.vertices.size());
  CHECK(mean / n == Approx(radius).margin(0.15 * kDx));
  CHECK(angle / n < 4);  // the lattice ball is a staircase
  CHECK(liquid_ok == n);
  // Every edge is shared by exactly two triangles.
  std::vector<std::pair<int, int>> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t e = 0; e < 3; ++e)
      edges.emplace_back(std::min(t[e], t[(e + 1) % 3]), std::max(t[e], t[(e + 1) % 3]));
  std::sort(edges.begin(), edges.end());
  bool closed = edges.size() % 2 == 0;
  for (std::size_t e = 0; closed && e < edges.size(); e += 2)
    closed = edges[e] == edges[e + 1] && (e + 2 == edges.size() || edges[e + 1] != edges[e + 2]);
  CHECK(closed);
}

TEST_CASE("a groove has flat walls with their normals down to a gap of less than a spacing") {
  // Layers along both walls, as of molten metal. At 1.8 spacings from the tip the walls are 0.93 apart.
  const double half_angle = 15 * kDegree, nearest = 1.8 * kDx;
  const Vec3 along(std::sin(half_angle), 0, std::cos(half_angle)), inward(along.z(), 0, -along.x());
  Metal m;
  for (const double side : {1.0, -1.0})
    for (int layer = 0; layer < 8; ++layer)
      for (int i = -30; i < 20; ++i) {
        const Vec3 p = kDx * ((i + 0.5) * along + (layer + 0.5) * inward);
        for (int j = -8; p.x() >= 0 && j < 8; ++j) m.add({side * p.x(), (j + 0.5) * kDx, p.z()});
      }
  const SurfaceMesh mesh = reconstruct_surface(m.cloud(), {{-4e-4, -2e-4, -2e-4}, {4e-4, 2e-4, 5e-4}});
  double off_wall = 0, lean = 0;
  int count = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3 x(std::abs(mesh.vertices[v].x()), 0, mesh.vertices[v].z());
    if (x.dot(along) < nearest || x.norm() > 8 * kDx) continue;
    const Vec3 normal(-std::copysign(inward.x(), mesh.vertices[v].x()), 0, -inward.z());
    off_wall = std::max(off_wall, std::abs(x.dot(inward)) / kDx);
    lean = std::max(lean, std::acos(std::min(1.0, mesh.normals[v].dot(normal))) / kDegree);
    ++count;
  }
  INFO("off the wall " << off_wall << ", normals off by " << lean << " degrees");
  CHECK(count > 100);
  // The sharpening that keeps the tip open sets the walls back a little where they are nearest.
  CHECK(off_wall < 0.2);
  CHECK(lean < 8);
}

TEST_CASE("sharpening acts on voids only") {
  // A film of one layer stays below one half, as a lone particle; a slit where one layer lacks is open, by up
  // to 0.4 spacings too wide. Two layers are resolved without.
  const Box region{{-3e-4, -3e-4, -3e-4}, {3e-4, 3e-4, 3e-4}};
  const Metal film = lattice({{-6e-4, -6e-4, 0}, {6e-4, 6e-4, kDx}}, everywhere);
  CHECK(reconstruct_surface(film.cloud(), region).triangles.empty());
  for (const auto& [layers, jitter] : {std::pair{1, 0.0}, {1, 0.1}, {2, 0.0}, {2, 0.1}}) {
    const double top = (10 + 0.5 * layers) * kDx, half_gap = 0.5 * layers * kDx;
    const Metal slit = lattice(
        {{-6e-4, -6e-4, -top}, {6e-4, 6e-4, top}}, [&](const Vec3& p) { return std::abs(p.z()) > half_gap; },
        jitter);
    const SurfaceMesh mesh = reconstruct_surface(slit.cloud(), region);
    REQUIRE(mesh.triangles.size() > 4 * 12 * 12);
    double gap = 0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      CHECK(mesh.vertices[v].z() * mesh.normals[v].z() < 0);
      gap += 2 * std::abs(mesh.vertices[v].z()) / kDx / static_cast<double>(mesh.vertices.size());
    }
    CHECK(gap > layers - 0.1);
    CHECK(gap < layers + (layers == 1 ? 0.4 : 0.1));
  }
}

TEST_CASE("liquid flags follow the nearest metal") {
  Metal m = lattice({{-6e-4, -6e-4, -4e-4}, {6e-4, 6e-4, 0}}, everywhere);
  // One molten layer on one half of the slab; molten metal three layers down on the other does not show.
  for (std::size_t i = 0; i < m.liquid.size(); ++i)
    m.liquid[i] = m.x[0][i] > 0 ? m.x[2][i] > -kDx : m.x[2][i] < -2 * kDx;
  const SurfaceMesh mesh = reconstruct_surface(m.cloud(), {{-4e-4, -4e-4, -2e-4}, {4e-4, 4e-4, 3e-4}});
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (std::abs(mesh.vertices[v].x()) > kDx) CHECK(mesh.liquid[v] == (mesh.vertices[v].x() > 0));
}

TEST_CASE("a narrow hole of particles is open and lit to its bottom") {
  const double radius = 1e-4, depth = 1e-3;
  for (const double jitter : {0.0, 0.15}) {
    const Metal m = lattice(
        {{-5e-4, -5e-4, -1.5e-3}, {5e-4, 5e-4, 0}},
        [&](const Vec3& p) { return p.z() < -depth || p.head<2>().norm() > radius; }, jitter);
    Tracer tracer;
    tracer.set_mesh(reconstruct_surface(m.cloud(), {{-4e-4, -4e-4, -1.4e-3}, {4e-4, 4e-4, 4e-4}}));
    BeamSpec s;
    s.focal_diameter = 1.6e-4;
    for (const Ray& ray : Beam(s).axis_bundle(0, 1e-3)) {
      const auto hit = tracer.first_hit(ray);
      REQUIRE(hit);
      CHECK(hit->z() == Approx(-depth).margin(1.0 * kDx));
    }
    s.power = 1;
    s.incidence_deg = 4;
    TraceOptions options;
    options.index_solid = {2.927, 4.377};
    const Trace t = tracer.trace(Beam(s).rays(0, 5000, 1e-3), options);
    CHECK(t.ledger.absorbed > 0.7);
    CHECK(t.ledger.bounces > 3 * 5000);
    double deepest = 0;
    for (const Hit& h : t.hits) deepest = std::min(deepest, h.position.z());
    CHECK(deepest == Approx(-depth).margin(1.0 * kDx));
    const double out = t.ledger.absorbed + t.ledger.escaped + t.ledger.residual + t.ledger.dropped;
    CHECK(std::abs(out - t.ledger.in) < 1e-12);
    // A perfect mirror absorbs nothing but what slips through the mesh and meets it from behind.
    options.fixed_absorptance = 0.0;
    CHECK(tracer.trace(Beam(s).rays(0, 5000, 1e-3), options).ledger.absorbed < 1e-3);
  }
}

TEST_CASE("odd clouds give a finite mesh or none") {
  const Box region{{-1e-3, -1e-3, -1e-3}, {1e-3, 1e-3, 1e-3}};
  Metal m;
  CHECK(reconstruct_surface(m.cloud(), region).triangles.empty());
  m.add({0, 0, 0});  // a lone particle fills no cell to one half
  CHECK(reconstruct_surface(m.cloud(), region).triangles.empty());
  m.add({5e-3, 0, 0});
  m.add({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  // A sheet of one layer, two particles on one spot, a cloud at random.
  for (int i = -5; i < 5; ++i)
    for (int j = -5; j < 5; ++j) m.add({i * kDx, j * kDx, 3e-4});
  for (int i = 0; i < 20; ++i) m.add({-5e-4, 0, 0});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1e-3, 1e-3);
  for (int i = 0; i < 20000; ++i) m.add({u(random), u(random), u(random)}, i % 2);
  const SurfaceMesh mesh = reconstruct_surface(m.cloud(), region);
  REQUIRE(!mesh.triangles.empty());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    CHECK(mesh.vertices[v].allFinite());
    CHECK(mesh.normals[v].norm() == Approx(1));
  }
  for (const auto& t : mesh.triangles) {
    const Vec3 ab =
        mesh.vertices[static_cast<std::size_t>(t[1])] - mesh.vertices[static_cast<std::size_t>(t[0])];
    const Vec3 ac =
        mesh.vertices[static_cast<std::size_t>(t[2])] - mesh.vertices[static_cast<std::size_t>(t[0])];
    CHECK(ab.cross(ac).norm() > 1e-4 * std::max(ab.squaredNorm(), ac.squaredNorm()));
  }
}

TEST_CASE("the mesh does not depend on the number of threads") {
  const Metal m = lattice(
      {{-6e-4, -6e-4, -9e-4}, {6e-4, 6e-4, 0}},
      [](const Vec3& p) { return p.z() < -6e-4 || p.head<2>().norm() > 1.1e-4; }, 0.2);
  const Box region{{-4e-4, -4e-4, -8e-4}, {4e-4, 4e-4, 3e-4}};
  const int before = threads();
  set_threads(1);
  const SurfaceMesh one = reconstruct_surface(m.cloud(), region);
  set_threads(2);
  const SurfaceMesh two = reconstruct_surface(m.cloud(), region);
  set_threads(before);
  CHECK(one.triangles == two.triangles);
  CHECK(one.liquid == two.liquid);
  CHECK(std::equal(one.vertices.begin(), one.vertices.end(), two.vertices.begin(), two.vertices.end()));
  CHECK(std::equal(one.normals.begin(), one.normals.end(), two.normals.begin(), two.normals.end()));
}
