// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/run_loop.hpp"
#include "app/signals.hpp"
#include "app/threads.hpp"
#include "meltray/app/commands.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/core/shell.hpp"
#include "meltray/scene/case_file.hpp"

namespace meltray::app {
namespace fs = std::filesystem;
namespace {

void tell(bool quiet, const std::string& text) {
  if (!quiet) fmt::print("{}\n", text);
}

void warn(const std::vector<std::string>& warnings) {
  for (const auto& w : warnings) fmt::print(stderr, "meltray: warning: {} (passed over)\n", w);
}

/// A fork keeps its particles, so it cannot change what they were made from.
void check_fork(const std::vector<std::string>& set) {
  for (const auto& s : set) {
    const std::string key = s.substr(0, s.find('='));
    const bool face = key.starts_with("faces.") && (key.ends_with(".kind") || key.ends_with(".velocity_m_s"));
    if (face || key.starts_with("domain.") || key.starts_with("material") || key.starts_with("bodies") ||
        key == "heat.initial_temperature_k")
      throw UsageError(
          fmt::format("--set {}: a fork keeps its particles; domain, bodies, walls, material and what they "
                      "start with need a new run",
                      s));
  }
}

/// Loads a checkpoint into a simulation that was made from the same particles.
RunState load(scene::Simulation& simulation, observe::Checkpoint& checkpoint) {
  RunState state;
  const std::size_t particles = simulation.particles().size();
  simulation.archive(*checkpoint.archive);
  state.archive(*checkpoint.archive);
  if (simulation.particles().size() != particles)
    throw UsageError(fmt::format("{}: {} particles, but the case makes {}", checkpoint.file.string(),
                                 simulation.particles().size(), particles));
  return state;
}

int fork(const ResumeArguments& arguments) {
  check_fork(arguments.set);
  const auto source = observe::RunFolder::open(arguments.run_folder);
  scene::Scene scene = scene::read_case(source.file("case.toml"), arguments.set);
  observe::CheckpointSlots source_slots(source.path(), source.run_id());
  std::vector<std::string> warnings;
  // After a failure the newest state is the one that failed.
  const bool failed = observe::recorded_outcome(source.path()) == "failed";
  auto checkpoint = source_slots.newest(failed, warnings);
  warn(warnings);
  if (!checkpoint) throw UsageError(fmt::format("{}: no checkpoint to fork from", source.path().string()));
  const double end = arguments.until.value_or(scene.time.end);
  if (end <= checkpoint->header.time)
    throw UsageError(fmt::format("{}: already at t = {:.9g} s; go further with --until",
                                 source.path().string(), checkpoint->header.time));
  scene.time.end = std::max(scene.time.end, end);

  scene::Simulation simulation(scene);
  RunState state = load(simulation, *checkpoint);
  state.case_fingerprint = fingerprint(scene);
  state.forked_from = fmt::format("{} at t = {:.9g} s", source.path().string(), checkpoint->header.time);

  observe::RunFolder::Options where;
  where.out = arguments.out;
  where.fork = true;
  auto folder = observe::RunFolder::create(where);
  write_case_file(folder, scene);
  fs::copy_file(source.file("history.csv"), folder.file("history.csv"));
  catch_signals();
  observe::CheckpointSlots slots(folder.path(), folder.run_id());
  RunLoop loop(simulation, folder, slots, state, {folder.path().filename().string(), end, arguments.quiet});
  loop.write_first_checkpoint();
  return loop.run();
}

}  // namespace

int resume(const ResumeArguments& arguments) {
  use_threads(arguments.threads);
  if (arguments.until && !std::isfinite(*arguments.until))
    throw UsageError(fmt::format("--until {}: a finite time is needed [s]", *arguments.until));
  if (arguments.out) return fork(arguments);
  if (!arguments.set.empty())
    throw UsageError("--set changes the run: give the new one a folder of its own with --out DIR");

  auto folder = observe::RunFolder::open(arguments.run_folder);
  scene::Scene scene = scene::read_case(folder.file("case.toml"));
  observe::CheckpointSlots slots(folder.path(), folder.run_id());
  std::vector<std::string> warnings;
  auto checkpoint = slots.newest(true, warnings);
  warn(warnings);
  const double end = arguments.until.value_or(scene.time.end);
  const std::string outcome = observe::recorded_outcome(folder.path());
  const double done = observe::recorded_time(folder.path());
  const bool ended = outcome == "finished" || outcome == "stopped";
  if ((ended || (checkpoint && arguments.until)) && end <= done * (1 + 1e-9)) {
    tell(arguments.quiet, fmt::format("{}: {} at t = {:.9g} s; nothing to do (--until goes further)",
                                      folder.path().string(), outcome, done));
    return kExitOk;
  }
  if (!checkpoint && ended)
    throw UsageError(
        fmt::format("{}: {} at t = {:.9g} s, but its checkpoints are gone; start it anew and replace what it "
                    "has with\n  meltray run CASE --out {} --overwrite",
                    folder.path().string(), outcome, done, shell_word(folder.path().string())));
  if (end > scene.time.end) {
    scene.time.end = end;
    write_case_file(folder, scene);
  }
  // Where scheduled checkpoints are asked for and the first one was not reached, only a new start takes the
  // path of the uninterrupted run.
  const double interval = scene.output.checkpoint_interval;
  if (checkpoint && !checkpoint->header.scheduled && checkpoint->header.time < interval) checkpoint.reset();

  catch_signals();
  const std::string name = observe::recorded_case(folder.path());
  scene::Simulation simulation(scene);
  RunState state;
  if (checkpoint) {
    state = load(simulation, *checkpoint);
    if (state.case_fingerprint != fingerprint(scene))
      throw UsageError(
          fmt::format("{}: was changed since {} was written, or comes from another version; fork with --set "
                      "KEY=VALUE --out DIR",
                      folder.file("case.toml").string(), checkpoint->file.string()));
    if (checkpoint->header.scheduled && done > checkpoint->header.time * (1 + 1e-9))
      tell(arguments.quiet,
           fmt::format(
               "going back from t = {:.9g} s to the last scheduled checkpoint, so that the result is that of "
               "the uninterrupted run",
               done));
    if (!checkpoint->header.scheduled)
      tell(arguments.quiet,
           "no scheduled checkpoint: going on from the one written when the run was stopped; the result "
           "differs from the uninterrupted run by round-off (output.checkpoint_interval_s sets scheduled "
           "ones)");
  } else {
    // Not silent in any case: what has been simulated is lost.
    fmt::print(
        stderr,
        "meltray: no scheduled checkpoint (output.checkpoint_interval_s) was reached before the run stopped "
        "at "
        "t = {:.9g} s: starting again from t = 0, as only this gives the result of the uninterrupted run\n",
        std::max(done, 0.0));
    state.case_fingerprint = fingerprint(scene);
    std::error_code ignored;
    for (const char* file : {"history.csv", "checkpoint-a.h5", "checkpoint-b.h5"})
      fs::remove(folder.file(file), ignored);
    fs::remove_all(folder.file("particles"), ignored);
    fs::create_directory(folder.file("particles"));
  }
  ++state.resumed;
  if (checkpoint) checkpoint->archive.reset();  // frees the file's copy in memory
  return RunLoop(simulation, folder, slots, state, {name, end, arguments.quiet}).run();
}

}  // namespace meltray::app
