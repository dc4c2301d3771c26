// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <cstdint>
#include <vector>

#include "meltray/materials/material.hpp"
#include "meltray/particles/patch.hpp"
#include "meltray/sph/pairs.hpp"
#include "meltray/terms/pressure/acoustic_pass.hpp"
#include "meltray/terms/stage.hpp"

namespace meltray::test {

/// A metal with round constants: every property that terms read is the same in both phases.
inline Material plain_metal() {
  Material m;
  m.name = "plain";
  m.density = 7000;
  m.heat_capacity_solid = m.heat_capacity_liquid = 700;
  m.conductivity_solid = m.conductivity_liquid = constant(35);
  m.solidus = 1800;
  m.liquidus = 1810;
  m.latent_heat_fusion = 250e3;
  m.boiling_temperature = 3100;
  m.latent_heat_vaporisation = 6e6;
  m.molar_mass = 0.056;
  m.viscosity = constant(5e-3);
  m.surface_tension = constant(1.8);
  m.expansion = 1e-4;
  m.expansion_reference = 1800;
  m.emissivity = 0.5;
  return m;
}

/// Deterministic numbers in [-1, 1) for jitter and random fields.
class Noise {
 public:
  explicit Noise(std::uint64_t seed = 1) : state_(seed * 0x9e3779b97f4a7c15ULL) {}
  double operator()() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) * (2.0 / 9007199254740992.0) - 1;
  }

 private:
  std::uint64_t state_;
};

/// Particles in a box with everything a term reads: fill(), wall(), then prepare().
struct StageSetup {
  terms::SceneConstants constants;
  Particles particles;
  PatchSelector selector;
  Patch patch;
  sph::PairList pairs;
  terms::Stage stage;

  explicit StageSetup(int dim, double spacing, Material material = plain_metal(),
                      sph::KernelType kernel = sph::KernelType::wendland_c2) {
    constants.dim = particles.dim = dim;
    constants.spacing = spacing;
    constants.smoothing = 1.3 * spacing;
    constants.material = std::move(material);
    constants.density = constants.material.density;
    constants.kernel = kernel;
    constants.lattice = sph::lattice_sums(kernel, dim, spacing, constants.smoothing);
  }
  StageSetup(const StageSetup&) = delete;
  StageSetup& operator=(const StageSetup&) = delete;

  double cell_volume() const { return std::pow(constants.spacing, constants.dim); }
  double cell_mass() const { return constants.density * cell_volume(); }

  void add(const Vec3& x, double temperature, bool liquid, int wall = 0) {
    particles.add(x, constants.material.enthalpy(temperature), cell_mass(), constants.smoothing,
                  static_cast<std::uint8_t>(wall));
    particles.temperature.back() = temperature;
    if (liquid) particles.phase.back() = static_cast<std::uint8_t>(Phase::liquid);
  }

  /// Calls f(x) for the points of a lattice of the spacing inside a box.
  template <class F>
  void for_lattice(const Vec3& min, const Vec3& max, F&& f) const {
    const double dx = constants.spacing;
    std::array<long, 3> n{1, 1, 1};
    for (int c = 0; c < constants.dim; ++c) n[c] = std::lround((max[c] - min[c]) / dx);
    for (long k = 0; k < n[2]; ++k)
      for (long j = 0; j < n[1]; ++j)
        for (long i = 0; i < n[0]; ++i) {
          Vec3 x = min + dx * Vec3(i + 0.5, j + 0.5, constants.dim == 3 ? k + 0.5 : 0.0);
          f(x);
        }
  }
  void fill(const Vec3& min, const Vec3& max, double temperature, bool liquid = true) {
    for_lattice(min, max, [&](const Vec3& x) { add(x, temperature, liquid); });
  }
  /// Three layers of dummies behind face `face` (x_min, x_max, y_min, ...) of the box [min, max].
  void dummies(int face, const Vec3& min, const Vec3& max, double temperature, double side = 0) {
    const int axis = axis_of(face);
    Vec3 low = min, high = max;
    for (int c = 0; c < constants.dim; ++c) {
      if (c == axis) continue;
      low[c] -= side;
      high[c] += side;
    }
    if (face % 2) {
      low[axis] = max[axis];
      high[axis] = max[axis] + 3 * constants.spacing;
    } else {
      high[axis] = min[axis];
      low[axis] = min[axis] - 3 * constants.spacing;
    }
    constants.faces[face].axis = axis;
    constants.faces[face].plane = face % 2 ? max[axis] : min[axis];
    for_lattice(low, high, [&](const Vec3& x) { add(x, temperature, false, face + 1); });
  }
  int axis_of(int face) const { return constants.dim == 3 ? face / 2 : (face < 2 ? 0 : 1); }

  void jitter(double share, std::uint64_t seed = 1) {
    Noise noise(seed);
    for (std::size_t i = 0; i < particles.size(); ++i)
      for (int c = 0; c < constants.dim; ++c) {
        const double d = share * constants.spacing * noise();
        if (!particles.is_wall(i)) particles.x[c][i] += d;
      }
  }

  /// Selects everything inside the box, builds lists for all particles but dummies, and prepares the stage.
  void prepare(const Vec3& min, const Vec3& max, std::array<bool, 3> periodic = {}) {
    selector = PatchSelector(CellGrid(constants.dim, min, max, 2 * constants.smoothing, periodic), particles);
    selector.select_all(particles, patch);
    std::vector<std::uint8_t> rows(patch.size());
    for (Index i = 0; i < patch.size(); ++i) rows[i] = !patch.wall[i];
    pairs.build(patch, selector.grid(), 0.0, rows);
    stage.constants = &constants;
    stage.patch = &patch;
    stage.pairs = &pairs;
    stage.heat = rows;
    terms::prepare_stage(stage);
    update();
  }
  /// Geometry, temperatures and surface of the patch's present positions and enthalpies.
  void update() {
    pairs.refresh(patch, constants.kernel);
    for (Index i = 0; i < patch.size(); ++i)
      stage.temperature[i] = constants.material.temperature(patch.h[i]);
    terms::compute_surface(stage);
  }

  /// Pairs, pressures and sums of a weakly compressible scene at the patch's densities.
  void evaluate(terms::AcousticPass& pass) {
    pass.find_pairs(stage, 0, pairs.period());
    pass.state.update(stage);
    pass.gather(stage);
    pass.evaluate(stage);
  }

  Vec3 position(Index i) const { return vector(patch.x, i); }
  Vec3 vector(const Components& f, Index i) const {
    Vec3 v = Vec3::Zero();
    for (int c = 0; c < constants.dim; ++c) v[c] = f[c][i];
    return v;
  }
  /// Sets the temperature (and so the enthalpy) of every patch particle from its position.
  template <class F>
  void set_temperature(F&& temperature) {
    for (Index i = 0; i < patch.size(); ++i)
      patch.h[i] = constants.material.enthalpy(temperature(position(i)));
    update();
  }
  template <class F>
  void set_velocity(F&& velocity) {
    for (Index i = 0; i < patch.size(); ++i) {
      const Vec3 v = velocity(position(i));
      for (int c = 0; c < constants.dim; ++c) patch.v[c][i] = v[c];
    }
  }
  ConstField velocity() const { return view(patch.v); }
  /// Zeros for a vector field of the patch.
  Components zeros() const {
    Components f;
    for (int c = 0; c < constants.dim; ++c) f[c].assign(patch.size(), 0.0);
    return f;
  }
};

}  // namespace meltray::test
