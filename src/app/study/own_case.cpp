// SPDX-License-Identifier: MIT
#include "app/study/own_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "meltray/core/errors.hpp"

namespace meltray::app::studies {
namespace {

Measure measure_of(const scene::Scene& s) {
  if (s.laser) return weld_quantities;
  if (!s.terms.pressure) return heat_quantities;
  return s.terms.conduction ? convection_quantities : flow_quantities;
}

}  // namespace

StudyScene own_case(const std::filesystem::path& case_file) {
  StudyScene own;
  own.id = case_file.stem().string();
  return own;
}

StudyScene own_case_in_steps(const std::filesystem::path& case_file, Cells& cells) {
  const scene::Scene s = scene::read_case(case_file);
  StudyScene own = own_case(case_file);
  own.measure = measure_of(s);
  double step = s.time.integrator.fixed_step;
  if (step == 0) {
    const Cell as_it_is = cells.run(s, own.measure, own.id);
    if (!as_it_is.finished)
      throw NumericalFailure(fmt::format("study: {} as it is: {}", case_file.string(), as_it_is.failure));
    step = s.time.end / static_cast<double>(std::max<std::int64_t>(1, as_it_is.steps));
  }
  own.longest_step = s.time.end / std::ceil(s.time.end / (2 * step));  // it ends on the end of the case
  if (s.laser) {
    own.halvings = 3;
    own.target = 0.1;
    if (s.domain.arrangement == scene::Arrangement::jittered) own.seeds = {1, 2, 3, 4, 5};
  }
  return own;
}

}  // namespace meltray::app::studies
