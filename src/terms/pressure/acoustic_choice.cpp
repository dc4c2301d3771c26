// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <string_view>

#include "meltray/core/errors.hpp"
#include "processor.hpp"
#include "terms/pressure/acoustic_kernel.hpp"

namespace meltray::terms {

namespace baseline {
const AcousticKernel& choose(int dim, bool cubic_spline);
}
namespace v3 {
const AcousticKernel& choose(int dim, bool cubic_spline);
}
namespace v4 {
const AcousticKernel& choose(int dim, bool cubic_spline);
}

namespace {

using Choose = const AcousticKernel& (*)(int dim, bool cubic_spline);

/// The builds of the loops that this processor can run, best first.
template <class F>
void for_builds(F&& f) {
#ifdef MELTRAY_WITH_V4
  if (processor_has_level(4)) f(v4::choose);
#endif
#ifdef MELTRAY_WITH_V3
  if (processor_has_level(3)) f(v3::choose);
#endif
  f(baseline::choose);
}

Choose best() {
  Choose chosen = nullptr;
  std::string names;
  const char* const asked = std::getenv("MELTRAY_INSTRUCTIONS");
  for_builds([&](Choose build) {
    const std::string_view name = build(3, false).instructions;
    if (!names.empty()) names += ", ";
    names += name;
    if (!chosen && (!asked || name == asked)) chosen = build;
  });
  if (!chosen)
    throw UsageError(
        fmt::format("MELTRAY_INSTRUCTIONS: found \"{}\"; allowed on this processor: {}", asked, names));
  return chosen;
}

}  // namespace

const AcousticKernel& acoustic_kernel(int dim, bool cubic_spline) {
  static const Choose choose = best();
  return choose(dim, cubic_spline);
}

}  // namespace meltray::terms
