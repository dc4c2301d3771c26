// SPDX-License-Identifier: MIT
#include "meltray/observe/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "meltray/core/errors.hpp"

namespace meltray::observe {
namespace fs = std::filesystem;
namespace {

/// The one list of columns: header and rows are both made from it.
template <class F>
void columns(const HistoryRow& r, F&& f) {
  f("time_s", r.time);
  f("laser_power_w", r.laser_power);
  f("absorbed_power_w", r.absorbed);
  f("escaped_power_w", r.escaped);
  f("residual_power_w", r.residual);
  f("capillary_depth_m", r.capillary_depth);
  f("axis_depth_m", r.axis_depth);
  f("closed", r.closed ? 1 : 0);
  f("pool_length_m", r.pool_length);
  f("pool_width_m", r.pool_width);
  f("pool_depth_m", r.pool_depth);
  f("top_surface_max_m", r.top_surface);
  f("max_temperature_k", r.max_temperature);
  f("max_speed_m_s", r.max_speed);
  f("liquid_particles", r.liquid);
  f("active_particles", r.active);
  f("ejected_mass_kg", r.ejected_mass);
  f("evaporative_loss_w", r.evaporative_loss);
  f("density_variation", r.density_variation);
  f("dt_s", r.dt);
  f("limiter", r.limiter);
  f("steps", r.steps);
  f("energy_stored_j", r.energy.stored - r.energy.initial);
  f("energy_laser_j", r.energy.laser);
  f("energy_boundary_j", r.energy.boundary);
  f("energy_evaporation_j", r.energy.evaporation);
  f("energy_radiation_j", r.energy.radiation);
  f("energy_ejected_j", r.energy.ejected);
  f("energy_cropped_j", r.energy.cropped);
  f("energy_undeposited_j", r.energy.undeposited);
  f("energy_relative_error", r.energy_error);
  f("schema_version", kHistorySchema);
}

std::vector<std::string> split(const std::string& text, char by) {
  std::vector<std::string> parts{""};
  for (const char c : text) {
    if (c == by)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

bool number(const std::string& text, double& v) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), v);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

void StepsSinceRow::add(const scene::StepInfo& step) {
  ++steps;
  seconds += step.dt;
  ++limiter[step.limiter];
}

std::string StepsSinceRow::main_limiter() const {
  const auto most = std::max_element(limiter.begin(), limiter.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == limiter.end() ? "start" : most->first;
}

void StepsSinceRow::archive(Archive& a) {
  std::string text;
  for (const auto& [name, n] : limiter) text += fmt::format("{}={};", name, n);
  a.value("observe/since_row/steps", steps);
  a.value("observe/since_row/seconds", seconds);
  a.value("observe/since_row/limiter", text);
  if (!a.loading()) return;
  limiter.clear();
  for (const auto& entry : split(text, ';'))
    if (const auto eq = entry.find('='); eq != std::string::npos)
      limiter[entry.substr(0, eq)] = std::stoll(entry.substr(eq + 1));
}

std::string history_header() {
  std::string line;
  columns(HistoryRow{}, [&](std::string_view name, const auto&) {
    if (!line.empty()) line += ',';
    line += name;
  });
  return line;
}

std::string history_line(const HistoryRow& row) {
  std::string line;
  columns(row, [&](std::string_view, const auto& value) {
    if (!line.empty()) line += ',';
    line += fmt::format("{}", value);
  });
  return line;
}

void cut_history(const fs::path& file, double time) {
  const std::string text = read_text(file);
  const std::string header = history_header() + '\n';
  if (!text.starts_with(header))
    throw UsageError(fmt::format("{}:1: the columns are not those of this program (schema {})", file.string(),
                                 kHistorySchema));
  std::size_t keep = header.size(), damaged = 0;  // end of the rows that stay; line that is no row
  for (std::size_t at = keep, line = 2; at < text.size(); ++line) {
    const auto end = text.find('\n', at);
    if (end == std::string::npos) break;
    double t = 0;
    if (!number(text.substr(at, text.find(',', at) - at), t)) {
      if (damaged == 0) damaged = line;
    } else if (t > time) {
      break;
    } else if (damaged > 0) {
      throw UsageError(
          fmt::format("{}:{}: no row of numbers, with rows that are kept behind it; mend it or move "
                      "the file away",
                      file.string(), damaged));
    } else {
      keep = end + 1;
    }
    at = end + 1;
  }
  if (keep != text.size()) replace_file(file, std::string_view(text).substr(0, keep));
}

std::map<std::string, std::vector<double>> read_history(const fs::path& file) {
  const auto lines = split(read_text(file), '\n');
  const auto names = split(lines[0], ',');
  if (std::find(names.begin(), names.end(), "time_s") == names.end())
    throw UsageError(fmt::format("{}:1: no column time_s: not a history.csv", file.string()));
  std::map<std::string, std::vector<double>> table;
  for (std::size_t l = 1; l < lines.size(); ++l) {
    if (lines[l].empty()) continue;
    const auto cells = split(lines[l], ',');
    // The last line of a run that is being written may be incomplete.
    if (cells.size() != names.size() && l + 1 == lines.size()) break;
    if (cells.size() != names.size())
      throw UsageError(
          fmt::format("{}:{}: {} fields, {} expected", file.string(), l + 1, cells.size(), names.size()));
    for (std::size_t c = 0; c < cells.size(); ++c) {
      double v = std::numeric_limits<double>::quiet_NaN();
      if (!number(cells[c], v) && names[c] != "limiter")
        throw UsageError(fmt::format("{}:{}: {}: found '{}'; a number is needed", file.string(), l + 1,
                                     names[c], cells[c]));
      table[names[c]].push_back(v);
    }
  }
  return table;
}

}  // namespace meltray::observe
