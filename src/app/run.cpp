// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/run_loop.hpp"
#include "app/signals.hpp"
#include "app/threads.hpp"
#include "meltray/app/commands.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/scene/case_file.hpp"
#include "meltray/scene/memory_needed.hpp"

namespace meltray::app {

int run(const RunArguments& arguments) {
  use_threads(arguments.threads);
  scene::Scene scene = scene::read_case(arguments.case_file, arguments.set);
  const double end = arguments.until.value_or(scene.time.end);
  if (!(end > 0) || !std::isfinite(end))
    throw UsageError(fmt::format("--until {}: a finite time after 0 is needed [s]", end));
  scene.time.end = std::max(scene.time.end, end);

  scene::refuse_more_than_memory_holds(scene);

  observe::RunFolder::Options where;
  where.out = arguments.out;
  where.overwrite = arguments.overwrite;
  where.case_name = arguments.case_file.stem().string();
  std::unique_ptr<scene::Simulation> simulation;
  // What is there is given up only for a run that can start.
  const bool replaces = arguments.overwrite && arguments.out && std::filesystem::exists(*arguments.out);
  if (replaces) simulation = std::make_unique<scene::Simulation>(scene);
  auto folder = observe::RunFolder::create(where);
  write_case_file(folder, scene);
  catch_signals();

  RunState state;
  state.case_fingerprint = fingerprint(scene);
  observe::CheckpointSlots slots(folder.path(), folder.run_id());
  std::optional<RunLoop> loop;
  try {
    if (!simulation) simulation = std::make_unique<scene::Simulation>(scene);
    loop.emplace(*simulation, folder, slots, state, RunLoop::Options{where.case_name, end, arguments.quiet});
  } catch (const std::exception& e) {
    record_failed_start(folder, where.case_name, e);
    throw;
  }
  return loop->run();
}

}  // namespace meltray::app
