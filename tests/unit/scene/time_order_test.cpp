// SPDX-License-Identifier: MIT
// Order in time of assembled scenes without events, and energy in those with melting.
#include <catch2/catch.hpp>

#include <cmath>

#include "meltray/core/constants.hpp"
#include "unit/scene/model_setup.hpp"

namespace meltray::scene {
namespace {

/// Velocities and enthalpies at the end of the vortices with fixed steps.
std::vector<double> solution(Method method, int order, double step) {
  Scene scene = read_case_text(test::vortices, "test.toml");
  scene.time.integrator.method = method;
  scene.time.integrator.order = order;
  scene.time.integrator.fixed_step = step;
  if (method != Method::imex) scene.time.conduction = scene.time.viscosity = PartitionChoice::automatic;
  scene.time.integrator.fast_step = method == Method::multirate ? step / 4 : 0;
  // With fixed steps the tolerances only end Newton's iteration.
  scene.time.rtol = 1e-10;
  scene.time.atol_position = scene.time.atol_velocity = scene.time.atol_temperature = 1e-9;
  const double end = scene.time.end;
  Simulation simulation(std::move(scene));
  Particles& p = simulation.particles();
  const double k = 2 * constants::pi;
  for (std::size_t i = 0; i < p.size(); ++i)
    p.h[i] =
        simulation.scene().material.enthalpy(400 + 50 * std::cos(k * p.x[0][i]) * std::cos(k * p.x[1][i]));
  while (simulation.time() < end) simulation.step(end);
  std::vector<double> out;
  for (std::size_t i = 0; i < p.size(); ++i) {
    out.push_back(p.v[0][i]);
    out.push_back(p.v[1][i]);
    out.push_back(0.02 * p.h[i]);  // 50 K count like 1 m/s
  }
  return out;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// A closed box in which a hot half melts into a cold one.
const std::string melting = R"(
[domain]
dimension = 2
min_m = [0.0, 0.0]
max_m = [1e-3, 1e-3]
spacing_m = 5e-5
[faces.x_min]
kind = "wall"
[faces.x_max]
kind = "wall"
[faces.z_min]
kind = "wall"
[faces.z_max]
kind = "wall"
[[bodies]]
shape = "box"
min_m = [0.0, 0.0]
max_m = [1e-3, 1e-3]
temperature_k = 1500.0
[[bodies]]
shape = "box"
min_m = [0.0, 0.0]
max_m = [5e-4, 1e-3]
temperature_k = 2600.0
[material]
name = "iron"
[terms]
conduction = true
melting = true
[splitting]
linear_tolerance = 1e-12
[time]
end_s = 1e-3
[output]
interval_s = 1.0
)";

}  // namespace

TEST_CASE("order in time: vortices with conduction and a viscosity that depends on temperature") {
  static const std::vector<double> exact = solution(Method::imex, 4, 0.04 / 160);
  struct Case {
    Method method;
    int order;
    double step;
  };
  // Order 4 takes longer steps: the pairs, in single precision, round at errors of 1e-9.
  const auto c = GENERATE(Case{Method::imex, 2, 0.04 / 20}, Case{Method::imex, 3, 0.04 / 10},
                          Case{Method::imex, 4, 0.04 / 6}, Case{Method::explicit_rk, 3, 0.04 / 10},
                          Case{Method::multirate, 3, 0.04 / 10});
  const double coarse = distance(solution(c.method, c.order, c.step), exact);
  const double fine = distance(solution(c.method, c.order, c.step / 2), exact);
  const double observed = std::log2(coarse / fine);
  CAPTURE(name_of(c.method), c.order, coarse, fine, observed);
  CHECK(std::abs(observed - c.order) < 0.2);
}

TEST_CASE("energy: conserved in a closed box with melting, by every method") {
  struct Case {
    Method method;
    int order;
  };
  const auto c =
      GENERATE(Case{Method::euler, 1}, Case{Method::imex, 2}, Case{Method::imex, 3}, Case{Method::imex, 4},
               Case{Method::imex, 5}, Case{Method::explicit_rk, 2}, Case{Method::explicit_rk, 5},
               Case{Method::implicit_rk, 2}, Case{Method::implicit_rk, 4}, Case{Method::multirate, 3},
               Case{Method::multirate, 4});
  Scene scene = read_case_text(melting, "test.toml");
  scene.time.integrator.method = c.method;
  scene.time.integrator.order = c.order;
  scene.time.integrator.fixed_step = 2e-5;
  const double end = scene.time.end;
  Simulation simulation(std::move(scene));
  const std::size_t liquid = simulation.liquid_count();
  while (simulation.time() < end) simulation.step(end);
  CAPTURE(name_of(c.method), c.order);
  CHECK(simulation.liquid_count() > liquid);
  CHECK(simulation.energy().relative_error() < 1e-10);
}

TEST_CASE("error control: cold solid far from the melt does not change the steps") {
  const auto steps_of =
      [](const char* depth) {
        const std::string text = std::string(R"(
[domain]
min_m = [0.0, 0.0, )") + depth + R"(]
max_m = [4e-4, 4e-4, 1e-4]
spacing_m = 5e-5
[faces.z_min]
kind = "wall"
[faces.x_min]
kind = "wall"
[faces.x_max]
kind = "wall"
[faces.y_min]
kind = "wall"
[faces.y_max]
kind = "wall"
[[bodies]]
shape = "box"
min_m = [0.0, 0.0, )" + depth + R"(]
max_m = [4e-4, 4e-4, 0.0]
temperature_k = 300.0
[[bodies]]
shape = "box"
min_m = [0.0, 0.0, -1e-4]
max_m = [4e-4, 4e-4, 0.0]
temperature_k = 2000.0
[material]
name = "iron"
[terms]
conduction = true
melting = true
pressure = true
viscosity = true
[heat]
bulk_interval_s = 1e-5
[time]
end_s = 3e-5
atol_temperature_k = 0.1
[output]
interval_s = 1.0
)";
        Simulation simulation(read_case_text(text, "test.toml"));
        std::vector<double> steps;
        bool controlled = false;
        while (simulation.time() < 3e-5) {
          const StepInfo info = simulation.step(3e-5);
          steps.push_back(info.dt);
          controlled = controlled || info.limiter == "error";
        }
        CHECK(controlled);
        return steps;
      };
  const auto shallow = steps_of("-4e-4"), deep = steps_of("-12e-4");
  REQUIRE(shallow.size() == deep.size());
  for (std::size_t k = 0; k < shallow.size(); ++k) CHECK(deep[k] == Approx(shallow[k]).epsilon(1e-6));
}

}  // namespace meltray::scene
