// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "app/study/quantities.hpp"
#include "meltray/scene/case_file.hpp"

namespace meltray::app::studies {

/// A scene of the studies: validation/studies/<id>.toml, and what is asked of it.
struct StudyScene {
  std::string id, summary;
  Measure measure = no_quantities;
  double longest_step = 0;  ///< of the fixed steps, halved from point to point [s]; 0: only for `stability`
  int halvings = 5;
  std::vector<double> spacings;  ///< resolutions, coarse first [m]; empty: that of the case
  std::vector<int> seeds;        ///< of the jitter, for chaotic scenes: means and their spread
  /// For `splitting`: the scene again with a term made stiffer.
  struct Strength {
    std::string name;
    scene::Overrides overrides;
  };
  std::vector<Strength> strengths;
  double target = 1e-3;  ///< for `splitting`: error of the first quantity at which costs are compared
};

const std::vector<StudyScene>& study_scenes();
/// Throws UsageError, with the nearest known id, where there is none.
const StudyScene& study_scene(const std::string& id);

}  // namespace meltray::app::studies
