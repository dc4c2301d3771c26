// SPDX-License-Identifier: MIT
// The right-hand side of an assembled scene: a function of the state alone, that allocates nothing.
#include <catch2/catch.hpp>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>

#include "unit/scene/model_setup.hpp"

namespace {
std::atomic<long> allocations{0};
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size > 0 ? size : 1)) return p;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto line = static_cast<std::size_t>(alignment);
  if (void* p = std::aligned_alloc(line, (size + line - 1) / line * line)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::align_val_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}

namespace meltray::scene {
namespace {

/// A pool of boiling iron in solid iron with every effect of a weld but its light, for a row of Table 1; open
/// at its end.
const std::string kPool = R"(
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
[[bodies]]
shape = "box"
min_m = [0.0, 0.0]
max_m = [1e-3, 0.6e-3]
temperature_k = 1500.0
[[bodies]]
shape = "box"
min_m = [0.3e-3, 0.2e-3]
max_m = [1e-3, 0.6e-3]
temperature_k = 3300.0
velocity_m_s = [0.1, 0.2]
[material]
name = "iron"
[terms]
conduction = true
viscosity = true
pressure = true
surface_tension = true
marangoni = true
wetting = true
recoil = true
evaporation = true
radiation = true
gravity = true
melting = true
[time]
method = "imex"
end_s = 1e-4
[output]
interval_s = 1e-4
[splitting]
conduction = "implicit"
viscosity = "implicit"
evaporation = "implicit"
)";

/// `text` with one line more at the end of a section.
std::string with(std::string text, const std::string& section, const std::string& line) {
  const std::string head = "[" + section + "]\n";
  return text.insert(text.find(head) + head.size(), line + "\n");
}

/// Moves, speeds up and heats every particle a little, each differently.
std::vector<double> disturbed(const std::vector<double>& y, std::size_t moving, double by) {
  std::vector<double> out = y;
  for (std::size_t k = 0; k < y.size(); ++k) {
    const double wave = std::sin(0.7 * static_cast<double>(k));
    out[k] += by * wave * (k < 2 * moving ? 0.05 : k < 4 * moving ? 1.0 : 50.0);
  }
  return out;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

/// Rates of every particle by its identity: the order of a patch follows the cells.
std::vector<std::vector<double>> by_particle(const Model& m, const std::vector<double>& rate) {
  const std::size_t moving = m.stage.moving.size();
  std::vector<std::vector<double>> out(m.patch.size());
  for (std::size_t k = 0; k < moving; ++k) {
    std::vector<double>& row = out.at(m.patch.global[m.stage.moving[k]]);
    for (std::size_t c = 0; c < 4; ++c) row.push_back(rate[c * moving + k]);
  }
  for (std::size_t k = 0; k < m.stage.heated.size(); ++k)
    out.at(m.patch.global[m.stage.heated[k]]).push_back(rate[4 * moving + k]);
  return out;
}

double largest_difference(const std::vector<std::vector<double>>& a,
                          const std::vector<std::vector<double>>& b) {
  double most = 0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, largest_difference(a[k], b[k]));
  return most;
}

double size_of(const std::vector<double>& a) {
  double most = 0;
  for (double x : a) most = std::max(most, std::abs(x));
  return most;
}

}  // namespace

TEST_CASE("right-hand side: the same, whatever was evaluated before") {
  test::ModelSetup fresh(test::vortices), used(test::vortices);
  const auto y = fresh.state(), other = disturbed(y, used.model.stage.moving.size(), 0.1);
  used.state();
  used.explicit_rate(y);
  used.implicit_rate(other);
  used.explicit_rate(other);
  // Conduction and viscosity bit for bit; the pressure starts from its last solution and is as exact as its
  // solve.
  CHECK(used.implicit_rate(y) == fresh.implicit_rate(y));
  const auto a = used.explicit_rate(y), b = fresh.explicit_rate(y);
  CHECK(largest_difference(a, b) < 1e-8 * size_of(b));
}

TEST_CASE("right-hand side: lists that are kept give the rates of lists that are new") {
  test::ModelSetup kept(test::vortices), renewed(test::vortices);
  const auto y = disturbed(kept.state(), kept.model.stage.moving.size(), 0.1);
  kept.explicit_rate(kept.state());
  renewed.state();
  renewed.model.evaluate(0, y.data());
  write_back(renewed.model.patch, renewed.particles);
  renewed.build_lists();
  const auto z = renewed.state();
  // Pairs may come in another order: sums agree to rounding, the pressure to the tolerance of its solve.
  const auto a = kept.implicit_rate(y), b = renewed.implicit_rate(z);
  CHECK(largest_difference(by_particle(kept.model, a), by_particle(renewed.model, b)) < 1e-12 * size_of(a));
  const auto c = kept.explicit_rate(y), d = renewed.explicit_rate(z);
  CHECK(largest_difference(by_particle(kept.model, c), by_particle(renewed.model, d)) < 1e-8 * size_of(c));
}

TEST_CASE("right-hand side: allocates nothing after the first") {
  const std::string text =
      GENERATE(as<std::string>{}, test::vortices, with(test::vortices, "flow", "shifting = 4.0"));
  test::ModelSetup setup(text);
  const auto y = setup.state();
  const std::size_t moving = setup.model.stage.moving.size();
  std::vector<std::vector<double>> states;
  for (int k = 0; k < 5; ++k) states.push_back(disturbed(y, moving, 0.02 * k));
  std::vector<double> rate(y.size()), b(y.size(), 1.0), z = y;
  const auto evaluate = [&](const std::vector<double>& s) {
    setup.model.explicit_rate(0, s.data(), rate.data());
    setup.model.implicit_rate(0, s.data(), rate.data());
    setup.model.solve_implicit(0, s.data(), 1e-4, b.data());
    setup.model.solve_linear(0, 1e-4, s.data(), z.data());
  };
  evaluate(states[0]);
  const long before = allocations;
  for (const auto& s : states) evaluate(s);
  CHECK(allocations == before);
}

TEST_CASE("right-hand side: allocates nothing after the first in any row of Table 1") {
  struct Row {
    std::string model, more;
  };
  const std::string interface = "[flow]\nreference_speed_m_s = 50.0\n";
  const auto row =
      GENERATE_COPY(Row{"isph", "projection = \"stage\"\n" + interface}, Row{"wcsph_reduced", ""},
                    Row{"wcsph_reduced_interface", interface}, Row{"wcsph", ""});
  CAPTURE(row.model);
  test::ModelSetup setup("model = \"" + row.model + "\"\n" + kPool + row.more);
  const auto y = setup.state();
  REQUIRE(!setup.model.stage.moving.empty());
  REQUIRE(setup.model.stage.elastic.empty() == (row.model != "wcsph"));
  std::vector<std::vector<double>> states(5, y);
  for (int k = 0; k < 5; ++k)
    for (std::size_t j = 0; j < y.size(); ++j)
      states[k][j] *= 1 + 1e-5 * k * std::sin(0.7 * static_cast<double>(j));
  std::vector<double> rate(y.size()), b(y.size(), 1.0);
  const auto evaluate = [&](const std::vector<double>& s) {
    setup.model.explicit_rate(0, s.data(), rate.data());
    setup.model.implicit_rate(0, s.data(), rate.data());
    setup.model.solve_implicit(0, s.data(), 1e-7, b.data());
  };
  evaluate(states[0]);
  const long before = allocations;
  for (const auto& s : states) evaluate(s);
  CHECK(allocations == before);
}

}  // namespace meltray::scene
