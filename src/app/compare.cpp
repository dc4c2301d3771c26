// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "app/measurements.hpp"
#include "app/response.hpp"
#include "meltray/app/commands.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/observe/history.hpp"
#include "meltray/observe/run_folder.hpp"
#include "meltray/scene/case_file.hpp"

namespace meltray::app {
namespace fs = std::filesystem;
namespace {

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

/// A measured row, and what each simulated depth is over it.
void print_measured(const Simulated& s, const Measurement& m) {
  const bool harmonic = m.definition.find("harmonic") != std::string::npos;
  const std::string ratio = m.ratio_mm_per_kw && m.uncertainty
                                ? fmt::format("{:.3f} ± {:.3f}", *m.ratio_mm_per_kw, *m.uncertainty)
                                : text(m.ratio_mm_per_kw);
  fmt::print(kRow, "", m.material, fmt::format("{:.4g}", m.frequency), "measured", harmonic ? "" : ratio,
             harmonic ? ratio : "", text(m.mean_depth_mm), text(m.phase_lag_deg, "{:.1f}"),
             m.definition.empty() ? m.source : m.definition + "; " + m.source);
  const auto over = [](double simulated, const std::optional<double>& measured) {
    return measured && *measured > 0 ? std::optional(simulated / *measured) : std::nullopt;
  };
  for (std::size_t k = 0; k < kDepths.size(); ++k) {
    const DepthResponse& d = s.depths[k];
    const auto quotient = over(harmonic ? d.harmonic_ratio : d.half_range_ratio, m.ratio_mm_per_kw);
    const auto lag =
        m.phase_lag_deg ? std::optional(std::remainder(d.lag - *m.phase_lag_deg, 360.0)) : std::nullopt;
    fmt::print(kRow, "", "", "", fmt::format("{}/measured", kDepths[k].name), harmonic ? "" : text(quotient),
               harmonic ? text(quotient) : "", text(over(d.mean, m.mean_depth_mm)),
               lag ? fmt::format("{:+.1f}", *lag) : "-", lag ? "(lag: difference)" : "");
  }
}

/// Materials are told by their names whatever their case.
bool same_material(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

}  // namespace

int compare(const std::vector<fs::path>& run_folders, const fs::path& measured) {
  const auto measurements = read_measurements(measured);
  std::vector<Simulated> simulated;
  for (const auto& folder : run_folders) simulated.push_back(analyse(folder));

  fmt::print(kRow, "run", "material", "f [Hz]", "depth", "ratio [mm/kW]", "harmonic [mm/kW]", "mean [mm]",
             "lag [deg]", "");
  for (const auto& s : simulated) {
    if (s.depths.empty()) {
      fmt::print(kRow, s.run, s.material, s.frequency > 0 ? fmt::format("{:.4g}", s.frequency) : "-", "-",
                 "-", "-", "-", "-", s.lacking);
      continue;
    }
    for (std::size_t k = 0; k < kDepths.size(); ++k) print_simulated(s, k);
    bool found = false;
    for (const auto& m : measurements)
      if (same_material(m.material, s.material) &&
          std::abs(m.frequency - s.frequency) <= 0.01 * s.frequency) {
        print_measured(s, m);
        found = true;
      }
    if (!found)
      fmt::print(kRow, "", "", "", "measured", "-", "-", "-", "-",
                 fmt::format("no row for {} at {:.4g} Hz in {}", s.material, s.frequency, measured.string()));
  }
  fmt::print(
      "depth: of the void that is connected to the space above, and along the axis of the beam;\n"
      "ratio: half of (max - min) of the period average over that of the power, ± its spread over periods;\n"
      "harmonic: amplitudes of the first harmonics, compared where the definition of a measurement says "
      "\"harmonic\";\n"
      "the first period is left out.\n");
  return kExitOk;
}

}  // namespace meltray::app
