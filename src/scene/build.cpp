// SPDX-License-Identifier: MIT
#include "scene/build.hpp"

#include <cmath>

#include "meltray/core/constants.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/scene/elastic.hpp"
#include "meltray/scene/lattice_layers.hpp"
#include "meltray/scene/memory_needed.hpp"

namespace meltray::scene {

namespace {

/// Faces are x_min, x_max, y_min, y_max, z_min, z_max; in 2-D component 1 is z.
int face_axis(int face, int dim) {
  return dim == 3 ? face / 2 : (face < 2 ? 0 : 1);
}
bool face_exists(int face, int dim) {
  return dim == 3 || face / 2 != 1;
}

/// Uniform in [-1, 1) from the lattice site and the seed (splitmix64): the same on every machine.
double jitter(std::uint64_t site, std::uint64_t component, std::uint64_t seed) {
  std::uint64_t z = (site * 3 + component) + 0x9e3779b97f4a7c15ULL * (seed + 1);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * (2.0 / 9007199254740992.0) - 1;
}

/// The last body that contains a point; null outside all.
const Body* body_at(const Domain& domain, const Vec3& x) {
  const Body* found = nullptr;
  for (const Body& b : domain.bodies) {
    bool inside = true;
    double r2 = 0;
    for (int c = 0; c < domain.dimension; ++c) {
      if (b.shape == ShapeKind::box)
        inside = inside && x[c] > b.min[c] && x[c] < b.max[c];
      else
        r2 += std::pow((x[c] - b.center[c]) / b.radii[c], 2);
    }
    if (inside && r2 < 1) found = &b;
  }
  return found;
}

Vec3 initial_velocity(const Domain& domain, const Body& body, const Vec3& x) {
  Vec3 v = body.velocity;
  const double u = domain.velocity_scale;
  if (domain.velocity_field == VelocityField::taylor_green) {
    const double kx = 2 * constants::pi / (domain.max[0] - domain.min[0]);
    const double kz = 2 * constants::pi / (domain.max[1] - domain.min[1]);
    v[0] -= u * std::cos(kx * x[0]) * std::sin(kz * x[1]);
    v[1] += u * std::sin(kx * x[0]) * std::cos(kz * x[1]);
  } else if (domain.velocity_field == VelocityField::rotation) {
    const Vec3 r = x - 0.5 * (domain.min + domain.max);
    v[0] -= u * r[1] / (domain.max[0] - domain.min[0]);
    v[1] += u * r[0] / (domain.max[0] - domain.min[0]);
  }
  return v;
}

/// Calls f(point, site number) for the sites of a lattice over the box, turned by fixed angles if asked for.
/// Those above one another follow one another, as in the cells of the grid.
template <class F>
void for_sites(const Domain& domain, F&& f) {
  const int dim = domain.dimension;
  const double dx = domain.spacing;
  if (domain.arrangement != Arrangement::rotated) {
    std::array<std::int64_t, 3> count{1, 1, 1};
    for (int c = 0; c < dim; ++c) count[c] = layers_along(domain, c);
    for (std::int64_t i = 0; i < count[0]; ++i)
      for (std::int64_t j = 0; j < count[1]; ++j)
        for (std::int64_t k = 0; k < count[2]; ++k) {
          const std::array<std::int64_t, 3> n{i, j, k};
          Vec3 x = Vec3::Zero();
          // Spread evenly where the length is no multiple of the spacing.
          for (int c = 0; c < dim; ++c)
            x[c] = domain.min[c] + (n[c] + 0.5) * (domain.max[c] - domain.min[c]) / count[c];
          f(x, (k * count[1] + j) * count[0] + i);
        }
    return;
  }
  const Vec3 centre = 0.5 * (domain.min + domain.max);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  const double a = 0.3, b = 0.47;  // no low-order symmetry of the lattice
  turn.topLeftCorner<2, 2>() << std::cos(a), -std::sin(a), std::sin(a), std::cos(a);
  if (dim == 3) turn = turn * Eigen::AngleAxisd(b, Vec3::UnitX()).toRotationMatrix();
  double reach = 0;
  for (int c = 0; c < dim; ++c) reach += std::pow(domain.max[c] - domain.min[c], 2);
  const auto n = static_cast<std::int64_t>(std::ceil(0.5 * std::sqrt(reach) / dx));
  std::uint64_t site = 0;
  for (std::int64_t k = dim == 3 ? -n : 0; k <= (dim == 3 ? n : 0); ++k)
    for (std::int64_t j = -n; j <= n; ++j)
      for (std::int64_t i = -n; i <= n; ++i, ++site) {
        Vec3 x = turn * Vec3(i + 0.5, j + 0.5, dim == 3 ? k + 0.5 : 0.0) * dx;
        for (int c = 0; c < dim; ++c) x[c] += centre[c];
        bool inside = true;
        for (int c = 0; c < dim; ++c) inside = inside && x[c] > domain.min[c] && x[c] < domain.max[c];
        if (inside) f(x, site);
      }
}

/// Volume of a site [m^3; m^2 in 2-D]. That of the spacing would give bodies another mass where layers are
/// spread over the box.
double site_volume(const Domain& domain) {
  double volume = 1;
  for (int c = 0; c < domain.dimension; ++c)
    volume *= domain.arrangement == Arrangement::rotated ? domain.spacing : layer_height(domain, c);
  return volume;
}

std::size_t count_in_bodies(const Domain& domain) {
  std::size_t count = 0;
  for_sites(domain, [&](const Vec3& x, std::uint64_t) { count += body_at(domain, x) != nullptr; });
  return count;
}

void add_bodies(const Scene& scene, const terms::SceneConstants& k, Particles& out) {
  const Domain& domain = scene.domain;
  const double mass = k.density * site_volume(domain);
  for_sites(domain, [&](Vec3 x, std::uint64_t site) {
    const Body* body = body_at(domain, x);
    if (!body) return;
    if (domain.arrangement == Arrangement::jittered)
      for (int c = 0; c < k.dim; ++c) x[c] += domain.jitter * k.spacing * jitter(site, c, domain.seed);
    out.add(x, scene.material.enthalpy(body->temperature), mass, k.smoothing);
    const std::size_t i = out.size() - 1;
    out.temperature[i] = body->temperature;
    const bool liquid = out.h[i] >= scene.material.enthalpy_liquidus();
    const bool clamped = !liquid && body->clamped;
    if (clamped) out.flags[i] |= kClamped;
    if (liquid) {
      out.phase[i] = static_cast<std::uint8_t>(Phase::liquid);
      out.flags[i] |= kWasLiquid;
    }
    if (liquid || (is_elastic(scene) && !clamped)) {
      const Vec3 v = initial_velocity(domain, *body, x);
      for (int c = 0; c < k.dim; ++c) out.v[c][i] = v[c];
    }
  });
}

/// Calls f(point, face) for the dummies of the faces that are walls.
template <class F>
void for_dummies(const Domain& domain, const terms::SceneConstants& k, F&& f) {
  const int layers = static_cast<int>(std::ceil(2 * k.smoothing / k.spacing)), dim = k.dim;
  std::array<std::int64_t, 3> count{1, 1, 1}, low{0, 0, 0}, high{1, 1, 1};
  for (int c = 0; c < dim; ++c) {
    count[c] = layers_along(domain, c);
    low[c] = 0;
    high[c] = count[c];
  }
  for (int face = 0; face < 6; ++face) {
    if (!face_exists(face, dim) || domain.faces[face].kind != FaceKind::wall) continue;
    (face % 2 ? high : low)[face_axis(face, dim)] += face % 2 ? layers : -layers;
  }
  for (std::int64_t z = low[2]; z < high[2]; ++z)
    for (std::int64_t y = low[1]; y < high[1]; ++y)
      for (std::int64_t x = low[0]; x < high[0]; ++x) {
        const std::array<std::int64_t, 3> n{x, y, z};
        int owner = -1;
        std::int64_t depth = 0;  // the face a dummy is farthest behind owns it
        for (int face = 0; face < 6; ++face) {
          if (!face_exists(face, dim) || domain.faces[face].kind != FaceKind::wall) continue;
          const int c = face_axis(face, dim);
          const std::int64_t behind = face % 2 ? n[c] - count[c] + 1 : -n[c];
          if (behind > depth) {
            depth = behind;
            owner = face;
          }
        }
        if (owner < 0) continue;
        Vec3 p = Vec3::Zero();
        for (int c = 0; c < dim; ++c)
          p[c] = domain.min[c] + (n[c] + 0.5) * (domain.max[c] - domain.min[c]) / count[c];
        f(p, owner);
      }
}

std::size_t count_dummies(const Domain& domain, const terms::SceneConstants& k) {
  std::size_t count = 0;
  for_dummies(domain, k, [&](const Vec3&, int) { ++count; });
  return count;
}

void add_dummies(const Scene& scene, const terms::SceneConstants& k, Particles& out) {
  const double mass = k.density * site_volume(scene.domain);
  for_dummies(scene.domain, k, [&](const Vec3& x, int owner) {
    const Face& face = scene.domain.faces[owner];
    const double t =
        face.thermal == ThermalKind::temperature ? face.temperature : scene.heat.initial_temperature;
    out.add(x, scene.material.enthalpy(t), mass, k.smoothing, static_cast<std::uint8_t>(owner + 1));
    const std::size_t i = out.size() - 1;
    out.temperature[i] = t;
    for (int c = 0; c < k.dim; ++c) out.v[c][i] = k.faces[owner].velocity[c];
  });
}

/// Every particle fills its lattice site. With thermal expansion its mass follows from its temperature, that
/// of elastic solid from the scene's initial temperature, at which the lattice is without stress.
void set_densities(const Scene& scene, const terms::SceneConstants& k, Particles& out) {
  out.density.assign(out.size(), k.density);
  if (!scene.flow.thermal_expansion) return;
  const bool elastic = is_elastic(scene);
  const double volume = site_volume(scene.domain);
  const double solid =
      elastic ? elastic_solid(scene).reference_density(k, scene.heat.initial_temperature) : k.density;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (!out.is_liquid(i) && !elastic) continue;
    out.density[i] = out.is_liquid(i) ? scene.material.density_of_t(out.temperature[i]) : solid;
    out.mass[i] = out.density[i] * volume;
  }
}

}  // namespace

terms::SceneConstants build_constants(const Scene& scene) {
  terms::SceneConstants k;
  k.dim = scene.domain.dimension;
  k.spacing = scene.domain.spacing;
  k.smoothing = scene.domain.smoothing_ratio * k.spacing;
  k.density = scene.material.density;
  k.kernel = scene.domain.kernel;
  k.lattice = sph::lattice_sums(k.kernel, k.dim, k.spacing, k.smoothing);
  k.material = scene.material;
  k.free_surface = scene.flow.free_surface;
  for (int f = 0; f < 6; ++f) {
    const Face& face = scene.domain.faces[f];
    terms::WallFace& wall = k.faces[f];
    wall.axis = face_axis(f, k.dim);
    if (!face_exists(f, k.dim)) continue;
    wall.plane = f % 2 ? scene.domain.max[wall.axis] : scene.domain.min[wall.axis];
    wall.no_slip = face.kind == FaceKind::wall && !face.slip;
    wall.velocity = face.velocity;
    wall.isothermal = face.kind == FaceKind::wall && face.thermal == ThermalKind::temperature;
    wall.temperature = face.temperature;
    wall.flux = face.thermal == ThermalKind::flux ? face.flux : 0.0;
    k.any_no_slip = k.any_no_slip || wall.no_slip;
    k.any_isothermal = k.any_isothermal || wall.isothermal;
  }
  return k;
}

Particles build_particles(const Scene& scene, const terms::SceneConstants& constants) {
  Particles out;
  out.dim = constants.dim;
  refuse_more_than_memory_holds(scene);
  // Most particles of a weld sleep in these arrays: they are made as long as needed, and no longer.
  out.reserve(count_in_bodies(scene.domain) + count_dummies(scene.domain, constants));
  add_bodies(scene, constants, out);
  if (out.size() == 0)
    throw UsageError("bodies: found no particle inside any body; allowed: bodies that overlap the box");
  add_dummies(scene, constants, out);
  if (scene.terms.pressure && scene.flow.solver == FlowSolver::wcsph) set_densities(scene, constants, out);
  if (is_elastic(scene))
    for (int c = 0; c < symmetric_count(out.dim); ++c) out.stress[c].assign(out.size(), 0.0);
  return out;
}

CellGrid build_grid(const Scene& scene, const terms::SceneConstants& k, double skin) {
  Vec3 min = scene.domain.min, max = scene.domain.max;
  std::array<bool, 3> periodic{};
  const double margin = std::ceil(2 * k.smoothing / k.spacing) * k.spacing;
  for (int c = 0; c < k.dim; ++c) {
    const int f = k.dim == 3 ? 2 * c : (c == 0 ? 0 : 4);
    periodic[c] = scene.domain.faces[f].kind == FaceKind::periodic;
    if (scene.domain.faces[f].kind == FaceKind::wall) min[c] -= margin;
    if (scene.domain.faces[f + 1].kind == FaceKind::wall) max[c] += margin;
  }
  return CellGrid(k.dim, min, max, 2 * k.smoothing + skin, periodic);
}

}  // namespace meltray::scene
