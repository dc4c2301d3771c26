// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "meltray/scene/case_file.hpp"
#include "meltray/scene/simulation.hpp"

using namespace meltray;

namespace {

/// Periodic strip of length 1 and sound speed 10: a wave of length 1 swings at 10 Hz.
const char* const kStrip = R"(
[domain]
dimension = 2
min_m = [0.0, 0.0]
max_m = [1.0, 0.25]
spacing_m = 0.025
[faces.x_min]
kind = "periodic"
[faces.x_max]
kind = "periodic"
[faces.z_min]
kind = "periodic"
[faces.z_max]
kind = "periodic"
[[bodies]]
shape = "box"
min_m = [0.0, 0.0]
max_m = [1.0, 0.25]
temperature_k = 400.0
[material]
name = "custom"
density_kg_m3 = 1.0
heat_capacity_solid_j_kg_k = 1.0
heat_capacity_liquid_j_kg_k = 1.0
solidus_k = 300.0
liquidus_k = 301.0
viscosity_pa_s = 1e-3
[terms]
pressure = true
[flow]
solver = "wcsph"
sound_speed_m_s = 10.0
density_diffusion = "none"
tension = "full"
[time]
end_s = 1.0
method = "explicit"
[output]
interval_s = 1.0
)";

constexpr double kWave = 2 * std::numbers::pi;

/// Amplitude of cos(2 pi x) in the density.
double amplitude(const Particles& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) sum += (p.density[i] - 1) * std::cos(kWave * p.x[0][i]);
  return 2 * sum / static_cast<double>(p.size());
}

/// The wave after `end`, started from rest with a density 1 + 1e-4 cos(2 pi x).
scene::Simulation wave(int order, double step) {
  auto scene = scene::read_case_text(
      kStrip, "strip", {"time.order=" + std::to_string(order), "time.fixed_step_s=" + std::to_string(step)});
  return scene::Simulation(scene);
}

void begin(scene::Simulation& s) {
  Particles& p = s.particles();
  for (std::size_t i = 0; i < p.size(); ++i) p.density[i] = 1 + 1e-4 * std::cos(kWave * p.x[0][i]);
}

}  // namespace

TEST_CASE("a standing sound wave swings at c / lambda at every explicit order") {
  const int order = GENERATE(2, 3, 4);
  scene::Simulation s = wave(order, 2e-4);
  begin(s);
  double crossing = 0, before = amplitude(s.particles()), t = 0;
  while (s.time() < 0.06) {
    s.step(1.0);
    const double now = amplitude(s.particles());
    if (before > 0 && now <= 0) crossing = t + (s.time() - t) * before / (before - now);
    before = now;
    t = s.time();
  }
  // First zero after a quarter of the period of 0.1 s. The kernel of h = 1.3 dx smooths a wave of 40 spacings
  // by (k h)^2 / 10 = 0.4 % in gradient and divergence each, and so its frequency.
  CHECK(crossing == Approx(0.025).epsilon(0.006));
}

TEST_CASE("explicit orders 2 to 4 of the weakly compressible flow are observed") {
  const int order = GENERATE(2, 3, 4);
  const auto density_after = [&](double step) {
    scene::Simulation s = wave(order, step);
    begin(s);
    while (s.time() < 0.016) s.step(0.016);
    return std::vector<double>(s.particles().density);
  };
  const auto exact = [&] {
    scene::Simulation s = wave(5, 1e-4);
    begin(s);
    while (s.time() < 0.016) s.step(0.016);
    return std::vector<double>(s.particles().density);
  }();
  const auto error = [&](double step) {
    const auto found = density_after(step);
    double sum = 0;
    for (std::size_t i = 0; i < found.size(); ++i) sum += (found[i] - exact[i]) * (found[i] - exact[i]);
    return std::sqrt(sum);
  };
  const double observed = std::log2(error(2e-3) / error(1e-3));
  CHECK(observed > order - 0.3);
}

TEST_CASE("multirate: fast sound beside slow conduction gives what one step for both gives") {
  // A hot stripe across the wave: its temperature spreads while sound passes ten times.
  const auto after = [&](const std::vector<std::string>& how) {
    std::vector<std::string> keys = {"terms.conduction=true", "material.conductivity_solid_w_m_k=0.05",
                                     "material.conductivity_liquid_w_m_k=0.05",
                                     "material.latent_heat_fusion_j_kg=0.0"};
    keys.insert(keys.end(), how.begin(), how.end());
    scene::Simulation s(scene::read_case_text(kStrip, "strip", keys));
    begin(s);
    Particles& p = s.particles();
    for (std::size_t i = 0; i < p.size(); ++i) {
      p.temperature[i] = 400 + 10 * std::cos(kWave * p.x[0][i]);
      p.h[i] = s.scene().material.enthalpy(p.temperature[i]);
    }
    while (s.time() < 0.1) s.step(0.1);
    std::vector<double> fields(p.density.begin(), p.density.end());
    for (double& f : fields) f = (f - 1) * 1e4;
    for (const double t : p.temperature) fields.push_back((t - 400) / 10);
    return fields;
  };
  const auto once = after({"time.order=3", "time.fixed_step_s=2.5e-4"});
  const auto split =
      after({"time.method=multirate", "time.order=3", "time.fixed_step_s=2e-3", "time.fast_step_s=2.5e-4"});
  const auto coarse =
      after({"time.method=multirate", "time.order=3", "time.fixed_step_s=4e-3", "time.fast_step_s=5e-4"});
  const auto largest = [&](const std::vector<double>& a) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - once[i]));
    return most;
  };
  CHECK(largest(split) < 1e-3);
  CHECK(largest(split) < 0.3 * largest(coarse));
  double spread = 0;
  for (std::size_t i = once.size() / 2; i < once.size(); ++i) spread = std::max(spread, once[i]);
  CHECK(spread < 0.9);  // conduction took part
}
