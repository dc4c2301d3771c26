// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/json_number.hpp"
#include "app/measurements.hpp"
#include "app/response.hpp"
#include "meltray/app/commands.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/observe/files.hpp"
#include "meltray/observe/history.hpp"
#include "meltray/observe/run_folder.hpp"
#include "meltray/observe/version.hpp"
#include "meltray/scene/case_file.hpp"

namespace meltray::app {
namespace fs = std::filesystem;
namespace {

constexpr int kSchemaVersion = 1;
constexpr const char* kRow = "{:<28} {:<10} {:>7} {:<14} {:>14} {:>16} {:>9} {:>11}  {}\n";

/// The two depths of a history: of the void that is connected to the space above, and along the axis of the
/// beam.
struct Depth {
  const char *name, *column;
};
constexpr std::array<Depth, 2> kDepths = {{{"void", "capillary_depth_m"}, {"axis", "axis_depth_m"}}};

struct Simulated {
  std::string run, material;
  double frequency = 0;
  std::vector<DepthResponse> depths;  ///< as kDepths; empty where there are too few periods
  std::string lacking;                ///< what is missing then
};

Simulated analyse(const fs::path& folder) {
  if (!observe::is_run_folder(folder))
    throw UsageError(fmt::format("{}: not a run folder of meltray", folder.string()));
  const scene::Scene scene = scene::read_case(folder / "case.toml");
  const fs::path name = folder.filename().empty() ? folder.parent_path().filename() : folder.filename();
  Simulated s{name.string(), scene.material.name, 0, {}, {}};
  if (!scene.laser || scene.laser->beam.modulation != laser::Modulation::sine ||
      !(scene.laser->beam.amplitude > 0)) {
    s.lacking = "its laser power is no sine: no amplitude to compare";
    return s;
  }
  s.frequency = scene.laser->beam.frequency;
  const auto table = observe::read_history(folder / "history.csv");
  try {
    for (const Depth& depth : kDepths) s.depths.push_back(depth_response(table, depth.column, s.frequency));
  } catch (const UsageError& e) {
    s.depths.clear();
    s.lacking = e.what();
  }
  return s;
}

std::string text(const std::optional<double>& v, const char* format = "{:.3f}") {
  return v ? fmt::format(fmt::runtime(format), *v) : "-";
}

void print_simulated(const Simulated& s, std::size_t k) {
  const DepthResponse& d = s.depths[k];
  fmt::print(kRow, k == 0 ? s.run : "", k == 0 ? s.material : "",
             k == 0 ? fmt::format("{:.4g}", s.frequency) : "", kDepths[k].name,
             fmt::format("{:.3f} ± {:.3f}", d.half_range_ratio, d.half_range_spread),
             fmt::format("{:.3f}", d.harmonic_ratio), fmt::format("{:.3f}", d.mean),
             fmt::format("{:.1f}", d.lag), fmt::format("{} period{}", d.periods, d.periods == 1 ? "" : "s"));
}

/// What a simulated depth is over a measured one; empty where that was not measured.
struct OverMeasured {
  std::optional<double> ratio, mean, lag_difference;  ///< the last in degrees
};

bool is_harmonic(const Measurement& m) {
  std::string words = m.definition;
  for (char& c : words) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return words.find("harmonic") != std::string::npos;
}

OverMeasured over(const DepthResponse& d, const Measurement& m) {
  const auto quotient = [](double simulated, const std::optional<double>& measured) {
    return measured && *measured > 0 ? std::optional(simulated / *measured) : std::nullopt;
  };
  return {quotient(is_harmonic(m) ? d.harmonic_ratio : d.half_range_ratio, m.ratio_mm_per_kw),
          quotient(d.mean, m.mean_depth_mm),
          m.phase_lag_deg ? std::optional(std::remainder(d.lag - *m.phase_lag_deg, 360.0)) : std::nullopt};
}

/// A measured row, and what each simulated depth is over it.
void print_measured(const Simulated& s, const Measurement& m) {
  const bool harmonic = is_harmonic(m);
  const std::string ratio = m.ratio_mm_per_kw && m.uncertainty
                                ? fmt::format("{:.3f} ± {:.3f}", *m.ratio_mm_per_kw, *m.uncertainty)
                                : text(m.ratio_mm_per_kw);
  fmt::print(kRow, "", m.material, fmt::format("{:.4g}", m.frequency), "measured", harmonic ? "" : ratio,
             harmonic ? ratio : "", text(m.mean_depth_mm), text(m.phase_lag_deg, "{:.1f}"),
             m.definition.empty() ? m.source : m.definition + "; " + m.source);
  for (std::size_t k = 0; k < kDepths.size(); ++k) {
    const OverMeasured q = over(s.depths[k], m);
    fmt::print(kRow, "", "", "", fmt::format("{}/measured", kDepths[k].name), harmonic ? "" : text(q.ratio),
               harmonic ? text(q.ratio) : "", text(q.mean), text(q.lag_difference, "{:+.1f}"),
               q.lag_difference ? "(lag: difference)" : "");
  }
}

/// A run with its two depths and what they are over each measurement of its metal and frequency.
nlohmann::json to_json(const Simulated& s, const std::vector<Measurement>& measurements) {
  nlohmann::json run = {{"run", s.run},
                        {"material", s.material},
                        {"frequency_hz", s.frequency > 0 ? nlohmann::json(s.frequency) : nullptr},
                        {"lacking", s.lacking},
                        {"depths", nlohmann::json::object()},
                        {"measured", nlohmann::json::array()}};
  for (std::size_t k = 0; k < s.depths.size(); ++k) {
    const DepthResponse& d = s.depths[k];
    run["depths"][kDepths[k].name] = {{"periods", d.periods},
                                      {"ratio_mm_per_kw", d.half_range_ratio},
                                      {"ratio_spread_mm_per_kw", d.half_range_spread},
                                      {"harmonic_mm_per_kw", d.harmonic_ratio},
                                      {"mean_mm", d.mean},
                                      {"lag_deg", d.lag}};
  }
  for (const Measurement& m : measurements) {
    nlohmann::json row = {{"amplitude", is_harmonic(m) ? "harmonic" : "half range"},
                          {"ratio_mm_per_kw", json_number(m.ratio_mm_per_kw)},
                          {"uncertainty_mm_per_kw", json_number(m.uncertainty)},
                          {"mean_mm", json_number(m.mean_depth_mm)},
                          {"lag_deg", json_number(m.phase_lag_deg)},
                          {"definition", m.definition},
                          {"source", m.source},
                          {"simulated_over_measured", nlohmann::json::object()}};
    for (std::size_t k = 0; k < s.depths.size(); ++k) {
      const OverMeasured q = over(s.depths[k], m);
      row["simulated_over_measured"][kDepths[k].name] = {
          {"ratio", json_number(q.ratio)},
          {"mean", json_number(q.mean)},
          {"lag_difference_deg", json_number(q.lag_difference)}};
    }
    run["measured"].push_back(row);
  }
  return run;
}

/// Materials are told by their names whatever their case.
bool same_material(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// Measurements of the metal and, to 1 %, the frequency of a run.
std::vector<Measurement> matching(const std::vector<Measurement>& all, const Simulated& s) {
  std::vector<Measurement> out;
  for (const Measurement& m : all)
    if (same_material(m.material, s.material) && std::abs(m.frequency - s.frequency) <= 0.01 * s.frequency)
      out.push_back(m);
  return out;
}

void print(const Simulated& s, const std::vector<Measurement>& measured, const std::string& file) {
  if (s.depths.empty()) {
    fmt::print(kRow, s.run, s.material, s.frequency > 0 ? fmt::format("{:.4g}", s.frequency) : "-", "-", "-",
               "-", "-", "-", s.lacking);
    return;
  }
  for (std::size_t k = 0; k < kDepths.size(); ++k) print_simulated(s, k);
  for (const Measurement& m : measured) print_measured(s, m);
  if (measured.empty())
    fmt::print(kRow, "", "", "", "measured", "-", "-", "-", "-",
               fmt::format("no row for {} at {:.4g} Hz in {}", s.material, s.frequency, file));
}

}  // namespace

int compare(const CompareArguments& a) {
  const auto measurements = read_measurements(a.measured);
  std::vector<Simulated> simulated;
  for (const auto& folder : a.run_folders) simulated.push_back(analyse(folder));

  fmt::print(kRow, "run", "material", "f [Hz]", "depth", "ratio [mm/kW]", "harmonic [mm/kW]", "mean [mm]",
             "lag [deg]", "");
  auto list = nlohmann::json::array();
  for (const auto& s : simulated) {
    const auto measured = matching(measurements, s);
    print(s, measured, a.measured.string());
    list.push_back(to_json(s, measured));
  }
  fmt::print(
      "depth: of the void that is connected to the space above, and along the axis of the beam;\n"
      "ratio: half of (max - min) of the period average over that of the power, ± its spread over periods;\n"
      "harmonic: amplitudes of the first harmonics, compared where the definition of a measurement says "
      "\"harmonic\";\n"
      "the first period is left out.\n");
  if (a.json) {
    const nlohmann::json document = {
        {"schema_version", kSchemaVersion}, {"version", observe::version()}, {"runs", list}};
    observe::write_file(*a.json, document.dump(2) + '\n');
  }
  return kExitOk;
}

}  // namespace meltray::app
