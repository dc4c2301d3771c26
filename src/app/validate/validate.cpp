// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/repository.hpp"
#include "app/validate/cases.hpp"
#include "app/validate/known_failures.hpp"
#include "app/validate/report.hpp"
#include "meltray/app/commands.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/core/nearest.hpp"
#include "meltray/observe/files.hpp"
#include "meltray/observe/run_folder.hpp"

namespace meltray::app {
namespace {

void check_choice(const ValidateArguments& a) {
  if (a.tier && (*a.tier < 1 || *a.tier > 3))
    throw UsageError(fmt::format("validate: --tier: found {}; allowed 1, 2 or 3", *a.tier));
  if ((a.all ? 1 : 0) + (a.tier ? 1 : 0) + (a.ids.empty() ? 0 : 1) > 1)
    throw UsageError("validate: found more than one of IDs, --all and --tier; allowed one of them");
  if (!a.all && !a.tier && a.ids.empty() && !a.small && !a.list)
    throw UsageError("validate: found no validation case; allowed IDs, --all, --tier, --small or --list");
}

/// The cases of the list that are asked for, in its order; --small and --list alone mean all.
std::vector<const ValidationCase*> selected(const ValidateArguments& arguments) {
  check_choice(arguments);
  std::vector<std::string> known;
  for (const ValidationCase& c : validation_cases()) known.emplace_back(c.id);
  for (const std::string& id : arguments.ids)
    if (std::find(known.begin(), known.end(), id) == known.end())
      throw UsageError(fmt::format("validate: found '{}'; allowed {}; did you mean '{}'?", id,
                                   fmt::join(known, ", "), nearest_name(id, known)));
  const auto wanted = [&](const ValidationCase& c) {
    if (arguments.tier) return c.tier == *arguments.tier;
    if (arguments.all) return c.tier <= 2;
    return arguments.ids.empty() ||
           std::find(arguments.ids.begin(), arguments.ids.end(), c.id) != arguments.ids.end();
  };
  std::vector<const ValidationCase*> out;
  for (const ValidationCase& c : validation_cases())
    if (wanted(c)) out.push_back(&c);
  for (const ValidationCase* c : out)
    if ((arguments.commands || arguments.finished) && (!c->welds || arguments.small))
      throw UsageError(fmt::format("validate: --commands and --finished: found {}{}; allowed welds of tier 3",
                                   c->id, arguments.small ? " with --small" : ""));
  return out;
}

/// What a case is run with; `references` is the folder of all validation cases.
Setting setting_of(const ValidationCase& c, const std::filesystem::path& references,
                   const ValidateArguments& arguments) {
  return {references / c.id, arguments.small, arguments.out / c.id};
}

bool any_reached(const std::vector<ListedRun>& welds) {
  return std::any_of(welds.begin(), welds.end(), [](const ListedRun& weld) {
    return reached(weld, observe::recorded_summary(weld.folder));
  });
}

/// --finished where nothing has finished is a mistyped folder: to compare nothing is no success.
void check_finished(const std::vector<const ValidationCase*>& cases, const std::filesystem::path& references,
                    const ValidateArguments& arguments) {
  std::vector<std::string> folders;
  for (const ValidationCase* c : cases) {
    const Setting setting = setting_of(*c, references, arguments);
    if (any_reached(c->welds(setting))) return;
    folders.push_back(setting.out.string());
  }
  throw UsageError(fmt::format("validate: --finished: no finished run in {}", fmt::join(folders, ", ")));
}

/// Does the welds of a case that are not done, or prints their commands. Returns an exit code.
int work_off(const ValidationCase& c, const Setting& setting, const ValidateArguments& arguments) {
  if (!c.welds || arguments.finished) return kExitOk;
  for (const ListedRun& weld : c.welds(setting)) {
    if (reached(weld, observe::recorded_summary(weld.folder))) continue;
    if (arguments.commands) {
      fmt::print("{}\n", command_of(weld));
      continue;
    }
    fmt::print(stderr, "{}\n", weld.folder.string());
    if (const int code = carry_out(weld, arguments.threads); code != kExitOk) return code;
  }
  return kExitOk;
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

/// The last line. True if no row failed.
bool print_counts(const Rows& rows) {
  const auto count = [&](auto&& which) { return std::count_if(rows.begin(), rows.end(), which); };
  const auto judged = count([](const Row& r) { return r.judged; });
  const auto failed = count([](const Row& r) { return !r.passed(); });
  const auto known = count([](const Row& r) { return !r.passed() && !r.known_failure.empty(); });
  const auto reported = count([](const Row& r) { return !r.judged; });
  fmt::print("{} rows judged: {} passed, {} failed, {} of these known; {} rows reported only\n", judged,
             judged - failed, failed, known, reported);
  return failed == 0;
}

}  // namespace

int validate(const ValidateArguments& arguments) {
  const auto cases = selected(arguments);
  if (arguments.list) {
    for (const ValidationCase* c : cases) fmt::print("{}  {:<27} {}\n", c->tier, c->id, c->summary);
    return kExitOk;
  }
  const auto folder = repository_folder("validation", "MELTRAY_VALIDATION");
  if (arguments.finished) check_finished(cases, folder, arguments);
  if (arguments.json) observe::check_writable(*arguments.json);  // not after hours of runs
  const KnownFailures known(folder / "known_failures.toml");
  Rows all;
  if (!arguments.commands) print_header();
  for (const ValidationCase* c : cases) {
    const Setting setting = setting_of(*c, folder, arguments);
    if (const int code = work_off(*c, setting, arguments); code != kExitOk) return code;
    if (arguments.commands) continue;
    Rows rows = run_case(*c, setting);
    known.mark(rows);
    print_rows(rows);
    all.insert(all.end(), rows.begin(), rows.end());
    if (arguments.json) write_json(*arguments.json, all);
  }
  if (arguments.commands) return kExitOk;
  return print_counts(all) ? kExitOk : kExitValidationFailed;
}

}  // namespace meltray::app
