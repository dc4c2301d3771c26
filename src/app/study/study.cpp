// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "app/repository.hpp"
#include "app/script.hpp"
#include "app/study/job.hpp"
#include "app/study/own_case.hpp"
#include "app/threads.hpp"
#include "meltray/app/commands.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/observe/files.hpp"
#include "meltray/observe/version.hpp"

namespace meltray::app {
namespace fs = std::filesystem;
using studies::Findings;
using studies::Json;
namespace {

constexpr int kSchemaVersion = 1;

std::string csv_cell(const Json& value) {
  if (value.is_null()) return "";
  if (!value.is_string()) return value.dump();
  // No text of ours holds a quotation mark.
  return value.get<std::string>().find(',') == std::string::npos ? value.get<std::string>() : value.dump();
}

std::string csv(const std::vector<Json>& rows) {
  std::vector<std::string> cells;
  if (!rows.empty())
    for (const auto& [name, value] : rows.front().items()) cells.push_back(name);
  std::string text = fmt::format("{}\n", fmt::join(cells, ","));
  for (const Json& row : rows) {
    cells.clear();
    for (const auto& [name, value] : row.items()) cells.push_back(csv_cell(value));
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return text;
}

std::string json(const StudyArguments& a, const std::string& id, const Findings& found) {
  const Json document = {{"schema_version", kSchemaVersion},
                         {"version", observe::version()},
                         {"study", a.kind},
                         {"scene", id},
                         {"small", a.small},
                         {"threads", threads()},
                         {"references", found.references},
                         {"conclusions", found.conclusions},
                         {"rows", found.rows}};
  return document.dump(2) + '\n';
}

/// A scene of the studies by its id.
studies::StudyScene known_scene(const StudyArguments& a) {
  studies::StudyScene found = studies::study_scene(a.what);
  if (a.kind != "stability" && found.longest_step == 0)
    throw UsageError(
        fmt::format("study {}: found '{}'; allowed for this scene: study stability", a.kind, a.what));
  return found;
}

}  // namespace

int study(const StudyArguments& a) {
  use_threads(a.threads);
  const bool own = fs::path(a.what).extension() == ".toml";
  const studies::StudyScene known = own ? studies::own_case(a.what) : known_scene(a);
  const fs::path out = a.out.value_or(fs::path("runs") / "studies" / known.id);
  const fs::path case_file =
      own ? fs::path(a.what)
          : repository_folder("validation", "MELTRAY_VALIDATION") / "studies" / (known.id + ".toml");
  scene::read_case(case_file);  // a bad file is refused before there is a folder
  studies::Cells cells(out / "cells");
  if (a.json) observe::check_writable(*a.json);  // not after hours; the folder may be that of the results
  const studies::StudyScene definition =
      own && a.kind != "stability" ? studies::own_case_in_steps(case_file, cells) : known;
  const studies::Job job{definition, case_file, a.small, cells};
  const Findings found = a.kind == "work-precision" ? work_precision(job)
                         : a.kind == "splitting"    ? splitting(job)
                                                    : stability(job, a.parameter);
  for (const std::string& line : found.conclusions) fmt::print("{}\n", line);
  const std::string text = json(a, definition.id, found);
  std::string stem = a.kind;
  if (a.kind == "stability")
    stem = fmt::format("{}-{}", a.kind, found.rows.front().at("parameter").get<std::string>());
  const fs::path data = out / (stem + ".json");
  observe::replace_file(data, text);
  observe::replace_file(out / (stem + ".csv"), csv(found.rows));
  if (a.json) observe::write_file(*a.json, text);
  fmt::print("{} runs, {} of them kept from before; {}/{}.csv\n", cells.computed() + cells.kept(),
             cells.kept(), out.string(), stem);
  return run_script("plot_study.py", {data.string()});
}

}  // namespace meltray::app
