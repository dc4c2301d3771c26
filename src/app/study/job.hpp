// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/study/catalogue.hpp"
#include "app/study/cells.hpp"
#include "app/study/variants.hpp"

namespace meltray::app::studies {

using Json = nlohmann::ordered_json;

/// A study under way: its scene, where it keeps its cells, and how much of it is wanted.
struct Job {
  StudyScene definition;
  std::filesystem::path case_file;
  bool small;  ///< the twin that takes seconds
  Cells& cells;

  /// How many seeds are run, 0 where the scene has none. Two are the least that have a spread.
  std::size_t seeds() const {
    const std::size_t all = definition.seeds.size();
    return small ? std::min<std::size_t>(2, all) : all;
  }
  /// The scene with overrides. With fixed steps its tolerances only tell Newton's method when to stop: they
  /// are then tight, so that the error is that of the steps.
  scene::Scene scene(const scene::Overrides& overrides = {}) const;
  /// Runs the scene with overrides and keeps the result.
  Cell run(const scene::Overrides& overrides) const {
    return cells.run(scene(overrides), definition.measure, definition.id);
  }
};

/// What a study found. Rows have the same keys in the same order: the columns of the CSV.
struct Findings {
  std::vector<Json> rows;
  std::vector<Json> references;  ///< what the errors are measured against, and how well that is known
  std::vector<std::string> conclusions;
};

Findings work_precision(const Job& job);
Findings splitting(const Job& job);
/// `parameter` is multiplied by factors; empty: the first that the scene has.
Findings stability(const Job& job, const std::string& parameter);
std::vector<std::string> stability_parameters(const scene::Scene& scene);

/// Solution of a model at one resolution, far more accurate than the points it judges.
struct Reference {
  Quantities quantities;
  std::vector<double> uncertainty;  ///< of each quantity, relative: distance to the second reference
  std::vector<double> spread;       ///< standard deviation over the seeds, relative; 0 with one seed
};

/// Fixed steps from `longest` down, halved; each ends on the scene's end.
std::vector<double> halved_steps(double longest, int halvings);

/// The same run for every seed of the scene; cost and quantities are means. A run that fails fails them all.
Cell run_seeds(const Job& job, const scene::Overrides& overrides, std::vector<Quantities>* single = nullptr);

/// The reference by steps of `step`, checked by one with steps twice as long; noted in the findings. Throws
/// NumericalFailure where one of them fails.
Reference reference(const Job& job, const std::string& model, const scene::Overrides& base, double step,
                    Findings& findings);

}  // namespace meltray::app::studies
