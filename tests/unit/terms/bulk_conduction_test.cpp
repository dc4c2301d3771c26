// SPDX-License-Identifier: MIT
#include "meltray/terms/bulk_conduction.hpp"

#include <catch2/catch.hpp>

#include "meltray/terms/conduction.hpp"
#include "unit/terms/stage_setup.hpp"

using namespace meltray;
using meltray::test::StageSetup;

namespace {

constexpr double kDx = 5e-5, kRest = 300;

/// A jittered block of solid with a hot spot on its top.
struct HotBlock : StageSetup {
  Vec3 max = Vec3::Constant(11 * kDx);
  HotBlock() : StageSetup(3, kDx) {
    fill(Vec3::Zero(), max, kRest, false);
    jitter(0.2);
    const Vec3 spot(5.5 * kDx, 5.5 * kDx, 11 * kDx);
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const double r = (Vec3(particles.x[0][i], particles.x[1][i], particles.x[2][i]) - spot).norm();
      set(i, r < 3.5 * kDx ? kRest + 1200 * (1 - r / (3.5 * kDx)) : kRest);
    }
    prepare(Vec3::Constant(-kDx), max + Vec3::Constant(kDx));
  }
  void set(std::size_t i, double t) {
    particles.h[i] = constants.material.enthalpy(t);
    particles.temperature[i] = t;
  }
  double energy() const {
    double sum = 0;
    for (std::size_t i = 0; i < particles.size(); ++i) sum += particles.mass[i] * particles.h[i];
    return sum;
  }
  terms::ConductionOperator op;
  std::vector<double> rate;
  /// Explicit steps of the operator of the state vector on the particles marked in `heat`.
  void full_steps(double dt, int steps) {
    for (int k = 0; k < steps; ++k) {
      reload(particles, patch);
      for (Index i = 0; i < patch.size(); ++i)
        stage.temperature[i] = constants.material.temperature(patch.h[i]);
      if (rate.empty()) op.assemble(stage);  // once: constant conductivity, nothing moves
      rate.assign(patch.size(), 0.0);
      op.add_heating(stage, rate.data());
      for (Index i = 0; i < patch.size(); ++i) {
        const Index g = patch.global[i];
        particles.h[g] += dt * rate[i];
        particles.temperature[g] = constants.material.temperature(particles.h[g]);
      }
    }
  }
};

double largest_rise(const HotBlock& b) {
  double t = 0;
  for (double x : b.particles.temperature) t = std::max(t, x - kRest);
  return t;
}

double largest_difference(const HotBlock& a, const HotBlock& b) {
  double d = 0;
  for (std::size_t i = 0; i < a.particles.size(); ++i)
    d = std::max(d, std::abs(a.particles.temperature[i] - b.particles.temperature[i]));
  return d;
}

constexpr double kInterval = 1e-5;
constexpr int kExchanges = 30, kFine = 5;

}  // namespace

TEST_CASE("bulk conduction: the history is that of the full operator and energy is exact") {
  HotBlock full, bulk;
  const double before = bulk.energy(),
               excess = before - 300.0 * 700 * bulk.cell_mass() * bulk.particles.size();
  full.full_steps(kInterval / kFine, kExchanges * kFine);
  terms::BulkConduction op;
  const std::vector<std::uint8_t> in_state(bulk.particles.size(), 0);
  for (int k = 0; k < kExchanges; ++k) {
    if (k % 5 == 0) op.build(bulk.constants, bulk.selector, bulk.particles, kRest);
    op.exchange(bulk.constants, kInterval, in_state, bulk.particles);
  }
  CHECK(largest_rise(bulk) < 0.5 * 1200);  // something happened
  CHECK(largest_difference(full, bulk) < 0.01 * largest_rise(full));
  CHECK(std::abs(bulk.energy() - before) < 1e-12 * before);
  CHECK(std::abs(bulk.energy() - before) < 1e-9 * excess);
}

TEST_CASE("bulk conduction: with a part in the state vector every pair counts once") {
  HotBlock full, split;
  const double before = split.energy();
  full.full_steps(kInterval / kFine, kExchanges * kFine);
  // The upper corner is in the state and its own pairs are stepped there, the rest by exchanges.
  std::vector<std::uint8_t> in_state(split.particles.size(), 0);
  for (std::size_t i = 0; i < in_state.size(); ++i)
    in_state[i] = split.particles.x[2][i] > 7 * kDx && split.particles.x[0][i] > 5 * kDx;
  for (Index i = 0; i < split.patch.size(); ++i) split.stage.heat[i] = in_state[split.patch.global[i]];
  terms::prepare_stage(split.stage);
  terms::BulkConduction op;
  for (int k = 0; k < kExchanges; ++k) {
    split.full_steps(kInterval / kFine, kFine);
    if (k % 5 == 0) op.build(split.constants, split.selector, split.particles, kRest);
    op.exchange(split.constants, kInterval, in_state, split.particles);
  }
  CHECK(std::abs(split.energy() - before) < 1e-12 * before);
  // First-order splitting at an interval of 0.2 of the time heat takes over a spacing.
  CHECK(largest_difference(full, split) < 0.01 * largest_rise(full));
}

TEST_CASE("bulk conduction: conductances of elastic solid go by the density that it has") {
  // Denser and heavier particles on the same sites: the same volumes, so that the same energy flows.
  HotBlock plain, dense;
  const double ratio = 1.056;
  dense.particles.density.assign(dense.particles.size(), ratio * dense.constants.density);
  for (double& m : dense.particles.mass) m *= ratio;
  for (auto& s : dense.particles.stress) s.assign(dense.particles.size(), 0.0);
  for (HotBlock* b : {&plain, &dense}) {
    const std::vector<std::uint8_t> in_state(b->particles.size(), 0);
    terms::BulkConduction op;
    op.build(b->constants, b->selector, b->particles, kRest);
    op.exchange(b->constants, 0.01 * kInterval, in_state, b->particles);
  }
  const HotBlock start;
  for (std::size_t i = 0; i < start.particles.size(); ++i) {
    const double flowed = plain.particles.mass[i] * (plain.particles.h[i] - start.particles.h[i]);
    CHECK(dense.particles.mass[i] * (dense.particles.h[i] - start.particles.h[i]) ==
          Approx(flowed).epsilon(1e-3).margin(1e-15));
  }
}

TEST_CASE("bulk conduction: what is at rest is not looked at, and melted particles are left alone") {
  HotBlock b;
  terms::BulkConduction op;
  op.build(b.constants, b.selector, b.particles, kRest);
  CHECK(op.rows() > 0);
  CHECK(op.rows() < b.particles.size());
  CHECK(op.bytes() > 0);
  const std::vector<std::uint8_t> in_state(b.particles.size(), 0);
  std::vector<std::size_t> melted;
  for (std::size_t i = 0; i < b.particles.size(); ++i)
    if (b.particles.temperature[i] > 1000) {
      b.particles.phase[i] = 1;
      melted.push_back(i);
    }
  REQUIRE_FALSE(melted.empty());
  const auto h = b.particles.h;
  const double before = b.energy();
  op.exchange(b.constants, kInterval, in_state, b.particles);
  for (std::size_t i : melted) CHECK(b.particles.h[i] == h[i]);
  CHECK(std::abs(b.energy() - before) < 1e-12 * before);

  HotBlock cold;
  for (std::size_t i = 0; i < cold.particles.size(); ++i) cold.set(i, kRest);
  op.build(cold.constants, cold.selector, cold.particles, kRest);
  CHECK(op.rows() == 0);
}
