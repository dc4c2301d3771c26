// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace meltray::app {

/// One row of a CSV of measured responses of the capillary depth; empty fields are empty here.
struct Measurement {
  std::string material;
  double frequency = 0;  ///< [Hz]
  std::optional<double> ratio_mm_per_kw, mean_depth_mm, phase_lag_deg;
  /// How the amplitude was taken: with the word "harmonic" in it the first harmonic, else half of max - min.
  std::string definition;
  std::optional<double> uncertainty;  ///< of the ratio [mm/kW]
  std::string source;
};

/// Reads columns material, f_hz, amplitude_ratio_mm_per_kw, mean_depth_mm, phase_lag_deg, definition,
/// uncertainty, source in any order; material and f_hz are needed. Empty lines and lines that begin with #
/// are skipped. Throws UsageError: "<file>:<line>: <column>: found <x>; allowed <y>".
std::vector<Measurement> read_measurements(const std::filesystem::path& file);

}  // namespace meltray::app
