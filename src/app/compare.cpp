// SPDX-License-Identifier: MIT
#include <fmt/format.h>

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

struct Simulated {
  std::string run, material;
  double frequency = 0;
  DepthResponse depth;
};

Simulated analyse(const fs::path& folder) {
  if (!observe::is_run_folder(folder))
    throw UsageError(fmt::format("{}: not a run folder of meltray", folder.string()));
  const scene::Scene scene = scene::read_case(folder / "case.toml");
  if (!scene.laser || scene.laser->beam.modulation != laser::Modulation::sine ||
      !(scene.laser->beam.amplitude > 0))
    throw UsageError(fmt::format("{}: its laser power is no sine: no amplitude to compare", folder.string()));
  const auto table = observe::read_history(folder / "history.csv");
  const double f = scene.laser->beam.frequency;
  try {
    return {folder.filename().empty() ? folder.parent_path().filename().string() : folder.filename().string(),
            scene.material.name, f, depth_response(table, "capillary_depth_m", f)};
  } catch (const UsageError& e) {
    throw UsageError(fmt::format("{}: {}", (folder / "history.csv").string(), e.what()));
  }
}

std::string text(const std::optional<double>& v, const char* format = "{:.3f}") {
  return v ? fmt::format(fmt::runtime(format), *v) : "-";
}

void print_simulated(const Simulated& s) {
  fmt::print(kRow, s.run, s.material, fmt::format("{:.4g}", s.frequency), "simulated",
             fmt::format("{:.3f} ± {:.3f}", s.depth.half_range_ratio, s.depth.half_range_spread),
             fmt::format("{:.3f}", s.depth.harmonic_ratio), fmt::format("{:.3f}", s.depth.mean),
             fmt::format("{:.1f}", s.depth.lag),
             fmt::format("{} period{}", s.depth.periods, s.depth.periods == 1 ? "" : "s"));
}

void print_measured(const Simulated& s, const Measurement& m) {
  const bool harmonic = m.definition.find("harmonic") != std::string::npos;
  const std::string ratio = m.ratio_mm_per_kw && m.uncertainty
                                ? fmt::format("{:.3f} ± {:.3f}", *m.ratio_mm_per_kw, *m.uncertainty)
                                : text(m.ratio_mm_per_kw);
  fmt::print(kRow, "", m.material, fmt::format("{:.4g}", m.frequency), "measured", harmonic ? "" : ratio,
             harmonic ? ratio : "", text(m.mean_depth_mm), text(m.phase_lag_deg, "{:.1f}"),
             m.definition.empty() ? m.source : m.definition + "; " + m.source);
  const double own = harmonic ? s.depth.harmonic_ratio : s.depth.half_range_ratio;
  const auto quotient =
      m.ratio_mm_per_kw && *m.ratio_mm_per_kw > 0 ? std::optional(own / *m.ratio_mm_per_kw) : std::nullopt;
  const auto depths =
      m.mean_depth_mm && *m.mean_depth_mm > 0 ? std::optional(s.depth.mean / *m.mean_depth_mm) : std::nullopt;
  const auto lag =
      m.phase_lag_deg ? std::optional(std::remainder(s.depth.lag - *m.phase_lag_deg, 360.0)) : std::nullopt;
  fmt::print(kRow, "", "", "", "sim/measured", harmonic ? "" : text(quotient), harmonic ? text(quotient) : "",
             text(depths), lag ? fmt::format("{:+.1f}", *lag) : "-", lag ? "(lag: difference)" : "");
}

}  // namespace

int compare(const std::vector<fs::path>& run_folders, const fs::path& measured) {
  const auto measurements = read_measurements(measured);
  std::vector<Simulated> simulated;
  for (const auto& folder : run_folders) simulated.push_back(analyse(folder));

  fmt::print(kRow, "run", "material", "f [Hz]", "", "ratio [mm/kW]", "harmonic [mm/kW]", "mean [mm]",
             "lag [deg]", "");
  for (const auto& s : simulated) {
    print_simulated(s);
    bool found = false;
    for (const auto& m : measurements)
      if (m.material == s.material && std::abs(m.frequency - s.frequency) <= 0.01 * s.frequency) {
        print_measured(s, m);
        found = true;
      }
    if (!found)
      fmt::print(kRow, "", "", "", "measured", "-", "-", "-", "-",
                 fmt::format("no row for {} at {:.4g} Hz in {}", s.material, s.frequency, measured.string()));
  }
  fmt::print(
      "ratio: half of (max - min) of the period average over that of the power, ± its spread over periods;\n"
      "harmonic: amplitudes of the first harmonics; the first period is left out.\n");
  return kExitOk;
}

}  // namespace meltray::app
