// SPDX-License-Identifier: MIT
#include "meltray/observe/summary.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "meltray/observe/files.hpp"
#include "meltray/observe/version.hpp"
#include "meltray/scene/optics.hpp"
#include "meltray/scene/presets.hpp"

namespace meltray::observe {
namespace {

using Json = nlohmann::ordered_json;

Json vector(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

Json shares_by_part(Timers& timers) {
  double total = 0;
  for (int i = 0; i < static_cast<int>(Part::count); ++i) total += timers.seconds(static_cast<Part>(i));
  Json parts = Json::object();
  for (int i = 0; i < static_cast<int>(Part::count); ++i) {
    const double s = timers.seconds(static_cast<Part>(i));
    parts[std::string(kPartNames[i])] = {{"seconds", s}, {"share", total > 0 ? s / total : 0}};
  }
  return parts;
}

Json energy_json(const scene::EnergyBudget& e) {
  return {{"initial_j", e.initial},
          {"stored_j", e.stored},
          {"laser_j", e.laser},
          {"boundary_j", e.boundary},
          {"evaporation_j", e.evaporation},
          {"radiation_j", e.radiation},
          {"ejected_j", e.ejected},
          {"cropped_j", e.cropped},
          {"undeposited_j", e.undeposited},
          {"relative_error", e.relative_error()}};
}

/// Relative to the largest momentum or impulse on the list.
Json momentum_json(const scene::MomentumBudget& m) {
  const Vec3 impulses = m.gravity + m.surface + m.pressure + m.viscosity + m.shifting + m.phase_change;
  const Vec3 gap = m.current - m.initial - impulses + m.ejected;
  double largest = 0;
  for (const Vec3& v : {m.initial, m.current, m.gravity, m.surface, m.pressure, m.viscosity, m.shifting,
                        m.phase_change, m.ejected})
    largest = std::max(largest, v.norm());
  return {{"unit", "kg m/s"},
          {"initial", vector(m.initial)},
          {"current", vector(m.current)},
          {"gravity", vector(m.gravity)},
          {"surface", vector(m.surface)},
          {"pressure", vector(m.pressure)},
          {"viscosity", vector(m.viscosity)},
          {"shifting", vector(m.shifting)},
          {"phase_change", vector(m.phase_change)},
          {"ejected", vector(m.ejected)},
          {"relative_error", largest > 0 ? gap.norm() / largest : 0}};
}

Json mass_json(const scene::MassBudget& m) {
  return {{"initial_kg", m.initial},
          {"current_kg", m.current},
          {"ejected_kg", m.ejected},
          {"cropped_kg", m.cropped},
          {"evaporated_not_removed_kg", m.evaporated_not_removed},
          {"relative_error",
           m.initial > 0 ? std::abs(m.current + m.ejected + m.cropped - m.initial) / m.initial : 0}};
}

Json laser_json(const scene::LaserBudget& l) {
  const double out = l.absorbed + l.escaped + l.residual + l.dropped;
  return {{"in_j", l.in},
          {"absorbed_j", l.absorbed},
          {"escaped_j", l.escaped},
          {"residual_j", l.residual},
          {"dropped_j", l.dropped},
          {"relative_error", l.in > 0 ? std::abs(l.in - out) / l.in : 0},
          {"worst_trace_relative_error", l.worst},
          {"traces", l.traces},
          {"rays", l.rays},
          {"dropped_rays", l.dropped_rays}};
}

Json density_json(const scene::Simulation& s, double mean) {
  if (s.scene().flow.solver != scene::FlowSolver::wcsph) return nullptr;
  const auto d = s.density_variation();
  return {{"now", d.now},         {"mean", mean},  // over the rows of history.csv
          {"largest", d.largest}, {"allowed", scene::DensityVariation::kAllowed},
          {"of_particles", 0.99}, {"sound_speed_m_s", s.scene().flow.sound_speed}};
}

Json index_json(std::complex<double> m) {
  return {{"n", m.real()}, {"k", m.imag()}, {"absorptance_normal", laser::absorptance(m, 1)}};
}

/// Which refractive index the laser met.
Json optics_json(const scene::Scene& s) {
  if (!s.laser) return nullptr;
  if (const auto fixed = s.laser->trace.fixed_absorptance)
    return {{"choice", "fixed"}, {"absorptance", *fixed}};
  const auto index = scene::laser_index(s);
  return {{"choice", scene::name_of(s.laser->optics)},
          {"solid", index_json(index.solid)},
          {"liquid", index_json(index.liquid)}};
}

}  // namespace

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);  // Linux counts in KiB
}

std::string summary_text(const RunRecord& r, scene::Simulation* simulation) {
  Json j = {{"schema_version", kSummarySchema},
            {"outcome", r.outcome},
            {"exit_code", r.exit_code},
            {"message", r.message},
            {"warnings", r.warnings},
            {"case", r.case_name},
            {"version", version()},
            {"threads", r.threads},
            {"target_time_s", r.target_time},
            {"wall_seconds", r.wall_seconds},
            {"session_wall_seconds", r.session_wall},
            {"session_start_s", r.session_start},
            {"resumed", r.resumed},
            {"forked_from", r.forked_from},
            {"checkpoint_time_s", r.checkpoint_time >= 0 ? Json(r.checkpoint_time) : Json()},
            {"peak_memory_bytes", peak_memory()}};
  if (simulation == nullptr) return j.dump(2) + "\n";

  const auto c = simulation->counters();
  const double simulated = simulation->time() - r.session_start;
  j["model"] = scene::row_of_table(simulation->scene());
  j["optics"] = optics_json(simulation->scene());
  j["density_variation"] = density_json(*simulation, r.mean_density_variation);
  j["time_s"] = simulation->time();
  j["wall_seconds_per_simulated_ms"] = simulated > 0 ? Json(r.session_wall / (1e3 * simulated)) : Json();
  j["particles"] = {{"liquid", simulation->liquid_count()}, {"active", r.active}};
  j["mean_liquid_particles"] =
      c.steps > 0 ? static_cast<double>(c.liquid_particle_steps) / static_cast<double>(c.steps) : 0.0;
  j["steps"] = c.steps;
  j["rejected_steps"] = c.rejected;
  j["explicit_evaluations"] = c.explicit_evals;
  j["implicit_evaluations"] = c.implicit_evals;
  j["linear_solves"] = c.linear_solves;
  j["pressure_solves"] = c.pressure_solves;
  j["pressure_iterations"] = c.pressure_iterations;
  j["pressure_solves_at_iteration_limit"] = c.pressure_at_limit;
  j["heat_iterations"] = c.heat_iterations;
  j["viscous_iterations"] = c.viscous_iterations;
  j["list_builds"] = c.list_builds;
  j["clamped"] = c.clamped;
  j["removed"] = c.removed;
  j["ejected"] = c.ejected;
  j["limiter"] = Json::object();
  for (const auto& [name, n] : c.limiter) j["limiter"][name] = n;
  j["memory_by_part_bytes"] = Json::object();
  for (const auto& [name, bytes] : r.memory) j["memory_by_part_bytes"][name] = bytes;
  j["time_by_part"] = shares_by_part(simulation->timers());
  j["budgets"] = {{"energy", energy_json(simulation->energy())},
                  {"momentum", momentum_json(simulation->momentum())},
                  {"mass", mass_json(simulation->mass())},
                  {"laser", laser_json(simulation->laser_budget())}};
  return j.dump(2) + "\n";
}

void write_summary(const std::filesystem::path& file, const RunRecord& record,
                   scene::Simulation* simulation) {
  replace_file(file, summary_text(record, simulation));
}

}  // namespace meltray::observe
