// SPDX-License-Identifier: MIT
#include "app/study/cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>

#include "app/validate/row.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/observe/files.hpp"
#include "meltray/scene/case_file.hpp"

namespace meltray::app::studies {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

double cpu_now() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Largest speed and extreme temperatures of a run so far.
void watch(const scene::Simulation& simulation, Cell& cell) {
  const Particles& p = simulation.particles();
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_wall(i) || p.has(i, kRemoved)) continue;
    const double t = simulation.scene().material.temperature(p.h[i]);
    cell.lowest_temperature = std::min(cell.lowest_temperature, t);
    cell.highest_temperature = std::max(cell.highest_temperature, t);
    double v2 = 0;
    for (int c = 0; c < p.dim; ++c) v2 += p.v[c][i] * p.v[c][i];
    cell.top_speed = std::max(cell.top_speed, std::sqrt(v2));
  }
}

/// What the impulses leave unexplained, over the melt's mass times its top speed: the impulses on a body at
/// rest cancel, and would be no measure.
double momentum_error(const scene::MomentumBudget& m, const Particles& p, double top_speed) {
  const Vec3 change = m.current - m.initial;
  const Vec3 supplied =
      m.gravity + m.surface + m.pressure + m.viscosity + m.shifting + m.phase_change - m.ejected;
  double mass = 0;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (p.is_liquid(i) && !p.is_wall(i)) mass += p.mass[i];
  const double size = mass * top_speed;
  return size > 0 ? (change - supplied).norm() / size : 0.0;
}

Cell compute(const scene::Scene& scene, Measure measure, std::int64_t largest_steps) {
  Cell cell;
  const Watch wall;
  const double cpu = cpu_now();
  scene::Simulation simulation(scene);
  cell.lowest_temperature = 1e300;
  watch(simulation, cell);
  cell.initial_speed = cell.top_speed;
  try {
    for (std::int64_t steps = 1; simulation.time() < scene.time.end; ++steps) {
      const std::string limiter = simulation.step(scene.time.end).limiter;
      watch(simulation, cell);
      if (steps == largest_steps && simulation.time() < scene.time.end)
        throw NumericalFailure(fmt::format("given up after {} steps: limited by '{}'", steps, limiter));
    }
    cell.finished = true;
    cell.quantities = measure(simulation);
  } catch (const NumericalFailure& e) {
    cell.failure = e.what();
  }
  cell.seconds = wall.seconds();
  cell.cpu_seconds = cpu_now() - cpu;
  cell.reached = simulation.time();
  const scene::Counters c = simulation.counters();
  cell.steps = c.steps;
  cell.rejected = c.rejected;
  cell.evaluations = c.explicit_evals + c.implicit_evals;
  cell.iterations = c.heat_iterations + c.viscous_iterations;
  cell.pressure_solves = c.pressure_solves;
  cell.pressure_iterations = c.pressure_iterations;
  cell.pressure_at_limit = c.pressure_at_limit;
  cell.clamped = c.clamped + c.removed;
  cell.liquid_particle_steps = c.liquid_particle_steps;
  cell.energy_error = simulation.energy().relative_error();
  cell.momentum_error = momentum_error(simulation.momentum(), simulation.particles(), cell.top_speed);
  return cell;
}

/// JSON has no infinity: a number that is not finite is stored as null.
void put(Json& json, const char* name, double value) {
  json[name] = std::isfinite(value) ? Json(value) : Json(nullptr);
}
double number(const Json& json) {
  return json.is_null() ? std::nan("") : json.get<double>();
}

/// Calls field(name, member) for every number of a cell.
template <class C, class Field>
void numbers(C& c, Field&& field) {
  field("reached_s", c.reached);
  field("seconds", c.seconds);
  field("cpu_seconds", c.cpu_seconds);
  field("energy_error", c.energy_error);
  field("momentum_error", c.momentum_error);
  field("initial_speed_m_s", c.initial_speed);
  field("top_speed_m_s", c.top_speed);
  field("lowest_temperature_k", c.lowest_temperature);
  field("highest_temperature_k", c.highest_temperature);
}
template <class C, class Field>
void counts(C& c, Field&& field) {
  field("steps", c.steps);
  field("rejected", c.rejected);
  field("evaluations", c.evaluations);
  field("iterations", c.iterations);
  field("pressure_solves", c.pressure_solves);
  field("pressure_iterations", c.pressure_iterations);
  field("pressure_at_limit", c.pressure_at_limit);
  field("clamped", c.clamped);
  field("liquid_particle_steps", c.liquid_particle_steps);
}

std::string write(const Cell& cell, const std::string& what) {
  Json json;
  json["run"] = what;
  json["finished"] = cell.finished;
  json["failure"] = cell.failure;
  numbers(cell, [&](const char* name, double x) { put(json, name, x); });
  counts(cell, [&](const char* name, std::int64_t n) { json[name] = n; });
  json["quantities"] = Json::array();
  for (const Quantity& q : cell.quantities)
    json["quantities"].push_back({{"name", q.name}, {"values", q.values}});
  return json.dump() + '\n';
}

Cell read(const std::string& text) {
  const Json json = Json::parse(text);
  Cell cell;
  cell.finished = json.at("finished");
  cell.failure = json.at("failure");
  numbers(cell, [&](const char* name, double& x) { x = number(json.at(name)); });
  counts(cell, [&](const char* name, std::int64_t& n) { n = json.at(name); });
  for (const Json& q : json.at("quantities")) {
    Quantity quantity{q.at("name"), {}};
    for (const Json& value : q.at("values")) quantity.values.push_back(number(value));
    cell.quantities.push_back(std::move(quantity));
  }
  return cell;
}

}  // namespace

Cells::Cells(fs::path folder)
    : folder_(std::move(folder)),
      program_(fmt::format("{:016x}", observe::fnv1a(observe::read_bytes("/proc/self/exe")))) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw IoError(fmt::format("{}: {}", folder_.string(), error.message()));
}

Cell Cells::run(const scene::Scene& scene, Measure measure, const std::string& what,
                std::int64_t largest_steps) {
  const std::string content =
      fmt::format("{}\n{}\n{}\n{}", program_, what, largest_steps, scene::write_case(scene));
  const fs::path file = folder_ / fmt::format("{:016x}.json", observe::fnv1a(content));
  if (fs::exists(file)) try {
      const Cell cell = read(observe::read_text(file));
      ++kept_;
      return cell;
    } catch (const nlohmann::json::exception&) {
      // Not a cell of ours, or cut short: computed anew.
    }
  const Cell cell = compute(scene, measure, largest_steps);
  observe::replace_file(file, write(cell, what));
  ++computed_;
  return cell;
}

std::string failed_term(const std::string& failure) {
  const auto after = [&](const std::string& mark, const char* stop) -> std::string {
    const auto at = failure.find(mark);
    if (at == std::string::npos) return {};
    const auto begin = at + mark.size();
    return failure.substr(begin, failure.find_first_of(stop, begin) - begin);
  };
  if (std::string term = after("last accepted state: ", "0123456789"); !term.empty()) {
    while (!term.empty() && term.back() == ' ') term.pop_back();
    return term;
  }
  if (const std::string limit = after("limited by '", "'"); !limit.empty()) return "step limit " + limit;
  if (failure.find("error estimate") != std::string::npos) return "error control";
  if (failure.find("implicit solve") != std::string::npos) return "implicit solve";
  if (failure.find("NaN") != std::string::npos) return "not finite";
  return failure.substr(0, failure.find(':'));
}

}  // namespace meltray::app::studies
