// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "app/study/quantities.hpp"

namespace meltray::app::studies {

/// One run of a scene to its end, and what it cost.
struct Cell {
  bool finished = false;
  std::string failure;  ///< message of the numerical failure
  double reached = 0;   ///< time [s]
  Quantities quantities;

  std::int64_t steps = 0, rejected = 0;
  std::int64_t evaluations = 0;  ///< of right-hand sides, explicit and implicit
  std::int64_t iterations = 0;   ///< of implicit solves: each applies the operator of its terms once
  std::int64_t pressure_solves = 0, pressure_iterations = 0, pressure_at_limit = 0;
  std::int64_t clamped = 0;  ///< or removed
  std::int64_t liquid_particle_steps = 0;
  double seconds = 0, cpu_seconds = 0;  ///< of the run that computed the cell

  double energy_error = 0, momentum_error = 0;  ///< of the budgets, relative
  double initial_speed = 0, top_speed = 0;      ///< largest of a particle: at the start, ever [m/s]
  double lowest_temperature = 0, highest_temperature = 0;  ///< ever [K]
};

/// Runs scenes, and keeps each result in a file of its own, named after the content of the run: the resolved
/// case, what is measured, and the program itself. A study that is started again goes on where it
/// stopped.
class Cells {
 public:
  /// Throws IoError where the folder cannot be made.
  explicit Cells(std::filesystem::path folder);

  /// A numerical failure is a result. `largest_steps` > 0: a run that needs more is given up as failed.
  Cell run(const scene::Scene& scene, Measure measure, const std::string& what,
           std::int64_t largest_steps = 0);

  int computed() const { return computed_; }
  int kept() const { return kept_; }

 private:
  std::filesystem::path folder_;
  std::string program_;  ///< fingerprint of the executable: any change of the code makes other cells
  int computed_ = 0, kept_ = 0;
};

/// The term that a failure message names: what pulled hardest, or what set a step that became too small.
std::string failed_term(const std::string& failure);

}  // namespace meltray::app::studies
