// SPDX-License-Identifier: MIT
// Pair loops, lists and solvers on a rotated, jittered block of liquid: lists that profit from an aligned
// lattice would flatter themselves. The argument of each benchmark is the number of particles along an edge.
// "pairs" is useful directed pairs a second; threads come from OMP_NUM_THREADS.
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <map>
#include <memory>

#include "meltray/laser/laser.hpp"
#include "meltray/terms/conduction.hpp"
#include "meltray/terms/pressure/acoustic_pass.hpp"
#include "meltray/terms/pressure/projection.hpp"
#include "meltray/terms/viscosity.hpp"
#include "unit/terms/stage_setup.hpp"

namespace {

using namespace meltray;

constexpr double kSpacing = 5e-5;
constexpr double kJitter = 0.15;

/// A ball of liquid cut from a rotated lattice, as many particles as a cube of `edge` along each side.
struct Ball : test::StageSetup {
  explicit Ball(int edge) : StageSetup(3, kSpacing) {
    const double radius = edge * kSpacing * std::cbrt(3 / (4 * M_PI)), reach = radius + 3 * kSpacing;
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.6, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    const Vec3 corner = Vec3::Constant(2 * std::ceil(radius / kSpacing) * kSpacing);
    for_lattice(-corner, corner, [&](const Vec3& x) {
      if (x.norm() < radius) add(turn * x, 2000, true);
    });
    jitter(kJitter);
    prepare(Vec3::Constant(-reach), Vec3::Constant(reach));
    pairs.refresh(patch, constants.kernel);
    terms::compute_surface(stage);
    test::Noise noise(7);
    for (int c = 0; c < 3; ++c)
      for (double& v : patch.v[c]) v = noise();
    acceleration = Components{};
    for (int c = 0; c < 3; ++c) acceleration[c].assign(patch.size(), 0.0);
  }
  Components acceleration;
};

Ball& ball(const benchmark::State& state) {
  static std::map<std::int64_t, std::unique_ptr<Ball>> made;
  auto& one = made[state.range(0)];
  if (!one) one = std::make_unique<Ball>(static_cast<int>(state.range(0)));
  return *one;
}

void count(benchmark::State& state, const Ball& b) {
  state.counters["particles"] = static_cast<double>(b.patch.size());
  state.counters["pairs"] =
      benchmark::Counter(static_cast<double>(b.pairs.pairs()), benchmark::Counter::kIsIterationInvariantRate);
}

void list_build(benchmark::State& state) {
  Ball& b = ball(state);
  const std::vector<std::uint8_t> all(b.patch.size(), 1);
  for (auto _ : state) b.pairs.build(b.patch, b.selector.grid(), 0.0, all);
  b.pairs.refresh(b.patch, b.constants.kernel);
  count(state, b);
}

void list_refresh(benchmark::State& state) {
  Ball& b = ball(state);
  for (auto _ : state) b.pairs.refresh(b.patch, b.constants.kernel);
  count(state, b);
}

void surface(benchmark::State& state) {
  Ball& b = ball(state);
  for (auto _ : state) terms::compute_surface(b.stage);
  count(state, b);
}

void viscous_product(benchmark::State& state) {
  Ball& b = ball(state);
  terms::ViscousOperator op;
  op.assemble(b.stage, {true, true}, {1, 1, 50, 50});
  for (auto _ : state)
    op.add_acceleration(b.stage, view(static_cast<const Components&>(b.patch.v)), view(b.acceleration));
  count(state, b);
}

void conduction_product(benchmark::State& state) {
  Ball& b = ball(state);
  terms::ConductionOperator op;
  op.assemble(b.stage);
  std::vector<double> heating(b.patch.size(), 0.0);
  for (auto _ : state) benchmark::DoNotOptimize(op.add_heating(b.stage, heating.data()));
  count(state, b);
}

void pressure_assembly(benchmark::State& state) {
  Ball& b = ball(state);
  terms::Projection projection;
  for (auto _ : state) projection.assemble(b.stage);
  count(state, b);
}

void pressure_product(benchmark::State& state) {
  Ball& b = ball(state);
  terms::Projection projection;
  projection.assemble(b.stage);
  std::vector<double> x(projection.rows(), 1.0), y(projection.rows());
  for (auto _ : state) solve::multiply(projection.matrix(), x, y);
  count(state, b);
}

/// From zero to a relative residual of 10^-range(1); "iterations" beside it.
void pressure_solve(benchmark::State& state) {
  Ball& b = ball(state);
  terms::Projection projection;
  projection.assemble(b.stage);
  std::vector<double> source;
  projection.divergence(b.stage, view(static_cast<const Components&>(b.patch.v)), source);
  const terms::ProjectionOptions options{terms::SurfaceEntry::csf, terms::PressureSolver::conjugate_gradients,
                                         std::pow(10.0, -static_cast<double>(state.range(1))), 2000};
  int iterations = 0;
  for (auto _ : state) {
    std::fill(b.patch.pressure.begin(), b.patch.pressure.end(), 0.0);
    iterations = projection.solve(b.stage, source, options).iterations;
  }
  state.counters["iterations"] = iterations;
  state.counters["particles"] = static_cast<double>(b.patch.size());
}

/// Continuity, pressure and artificial viscosity; with Antuono's diffusion where range(1) is 1.
void acoustic_pass(benchmark::State& state) {
  Ball& b = ball(state);
  terms::AcousticPass pass;
  pass.state.sound_speed = 40;
  pass.artificial.alpha = 0.1;
  if (state.range(1)) pass.diffusion.coefficient = 0.1;
  b.patch.density.assign(b.patch.size(), b.constants.density);
  b.evaluate(pass);
  for (auto _ : state) pass.evaluate(b.stage);
  count(state, b);
  state.SetLabel(terms::AcousticPass::instructions());
}

/// Positions and fields into octets; no walls here.
void acoustic_gather(benchmark::State& state) {
  Ball& b = ball(state);
  terms::AcousticPass pass;
  b.patch.density.assign(b.patch.size(), b.constants.density);
  b.evaluate(pass);
  for (auto _ : state) pass.gather(b.stage);
  count(state, b);
}

void acoustic_pairs(benchmark::State& state) {
  Ball& b = ball(state);
  terms::AcousticPass pass;
  for (auto _ : state) pass.find_pairs(b.stage, 0, {});
  count(state, b);
  sph::ClusterSet set;
  sph::ClusterList list;
  set.sort(b.patch, std::vector<std::uint8_t>(b.patch.size(), 1), 1, kSpacing, {});
  list.build(set, set, 2 * b.constants.smoothing);
  const double lanes = 1.0 * list.start()[set.groups()] * sph::kGroupRows * sph::kLanes;
  state.counters["useful_lanes"] = static_cast<double>(b.pairs.pairs()) / lanes;
  state.counters["slots"] = set.slots();
}

/// A capillary of 2.5 spacings' radius, disordered, `depth` spacings deep, and the light in it.
struct Capillary {
  explicit Capillary(int depth) {
    test::Noise noise(5);
    for (int k = 0; k < depth + 15; ++k)
      for (int j = -12; j < 12; ++j)
        for (int i = -12; i < 12; ++i) {
          const Vec3 x(i + 0.5, j + 0.5, -k - 0.5);
          if (k < depth && x.head<2>().norm() < 2.5) continue;
          for (int c = 0; c < 3; ++c)
            position[static_cast<std::size_t>(c)].push_back(kSpacing * (x[c] + kJitter * noise()));
          liquid.push_back(x.head<2>().norm() < 4.5 ? 1 : 0);
        }
    region = {Vec3(-9, -9, -depth - 6) * kSpacing, Vec3(9, 9, 6) * kSpacing};
  }
  laser::SurfaceMesh mesh() const {
    return laser::reconstruct_surface({{position[0].data(), position[1].data(), position[2].data()},
                                       position[0].size(),
                                       liquid.data(),
                                       kSpacing},
                                      region);
  }
  std::array<std::vector<double>, 3> position;
  std::vector<std::uint8_t> liquid;
  laser::Box region;
};

void light_mesh(benchmark::State& state) {
  const Capillary capillary(static_cast<int>(state.range(0)));
  std::size_t triangles = 0;
  for (auto _ : state) triangles = capillary.mesh().triangles.size();
  state.counters["particles"] = static_cast<double>(capillary.position[0].size());
  state.counters["triangles"] = static_cast<double>(triangles);
}

void light_tree(benchmark::State& state) {
  const laser::SurfaceMesh mesh = Capillary(static_cast<int>(state.range(0))).mesh();
  laser::Tracer tracer;
  for (auto _ : state) tracer.set_mesh(mesh);
}

void light_rays(benchmark::State& state) {
  laser::Tracer tracer;
  tracer.set_mesh(Capillary(static_cast<int>(state.range(0))).mesh());
  laser::BeamSpec spec;
  spec.power = 2000;
  spec.focal_diameter = 2e-4;
  laser::TraceOptions options;
  options.index_solid = options.index_liquid = {3.6, 5.0};
  const auto rays = laser::Beam(spec).rays(0, 300, 10 * kSpacing);
  std::size_t hits = 0;
  for (auto _ : state) hits = tracer.trace(rays, options).hits.size();
  state.counters["hits"] = static_cast<double>(hits);
}

}  // namespace

#define MELTRAY_SIZES ->Arg(14)->Arg(27)->Arg(46)->Unit(benchmark::kMillisecond)->UseRealTime()
BENCHMARK(list_build) MELTRAY_SIZES;
BENCHMARK(list_refresh) MELTRAY_SIZES;
BENCHMARK(surface) MELTRAY_SIZES;
BENCHMARK(viscous_product) MELTRAY_SIZES;
BENCHMARK(conduction_product) MELTRAY_SIZES;
BENCHMARK(acoustic_pass)->ArgsProduct({{14, 27, 46}, {0, 1}})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(acoustic_gather) MELTRAY_SIZES;
BENCHMARK(acoustic_pairs) MELTRAY_SIZES;
BENCHMARK(pressure_assembly) MELTRAY_SIZES;
BENCHMARK(pressure_product) MELTRAY_SIZES;
BENCHMARK(pressure_solve)->ArgsProduct({{14, 27, 46}, {3, 6}})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(light_mesh)->Arg(30)->Arg(60)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(light_tree)->Arg(60)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(light_rays)->Arg(60)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_MAIN();
