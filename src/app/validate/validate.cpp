// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "app/repository.hpp"
#include "app/validate/cases.hpp"
#include "app/validate/report.hpp"
#include "meltray/app/commands.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/core/nearest.hpp"

namespace meltray::app {
namespace {

/// The named cases in the order of the list, or all of them.
std::vector<const ValidationCase*> selected(const ValidateArguments& arguments) {
  std::vector<std::string> known;
  for (const ValidationCase& c : validation_cases()) known.emplace_back(c.id);
  for (const std::string& id : arguments.ids)
    if (std::find(known.begin(), known.end(), id) == known.end())
      throw UsageError(fmt::format("validate: found '{}'; allowed {}; did you mean '{}'?", id,
                                   fmt::join(known, ", "), nearest_name(id, known)));
  const bool all = arguments.all || (arguments.ids.empty() && (arguments.small || arguments.list));
  if (!all && arguments.ids.empty())
    throw UsageError("validate: found no validation case; allowed IDs, --all, --small or --list");
  std::vector<const ValidationCase*> out;
  for (const ValidationCase& c : validation_cases())
    if (all || std::find(arguments.ids.begin(), arguments.ids.end(), c.id) != arguments.ids.end())
      out.push_back(&c);
  return out;
}

/// A case that breaks down has failed; the others go on.
Rows run_case(const ValidationCase& c, const Setting& setting) {
  Rows rows;
  try {
    rows = c.run(setting);
  } catch (const NumericalFailure& e) {
    fmt::print(stderr, "meltray: {}: {}\n", c.id, e.what());
    rows.push_back(
        limit_row("runs to its end", std::numeric_limits<double>::quiet_NaN(), 0, {"", 0, e.what()}));
  }
  for (Row& row : rows) row.id = c.id;
  return rows;
}

}  // namespace

int validate(const ValidateArguments& arguments) {
  const auto cases = selected(arguments);
  if (arguments.list) {
    for (const ValidationCase* c : cases) fmt::print("{:<24} {}\n", c->id, c->summary);
    return kExitOk;
  }
  const auto folder = repository_folder("validation", "MELTRAY_VALIDATION");
  Rows all;
  print_header();
  for (const ValidationCase* c : cases) {
    const Rows rows = run_case(*c, {folder / c->id, arguments.small});
    print_rows(rows);
    all.insert(all.end(), rows.begin(), rows.end());
    if (arguments.json) write_json(*arguments.json, all);
  }
  const auto failed = std::count_if(all.begin(), all.end(), [](const Row& r) { return !r.passed(); });
  fmt::print("{} of {} rows passed\n", all.size() - static_cast<std::size_t>(failed), all.size());
  return failed == 0 ? kExitOk : kExitValidationFailed;
}

}  // namespace meltray::app
