// SPDX-License-Identifier: MIT
#include "app/run_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <numeric>

#include "app/doubtful_settings.hpp"
#include "app/known_limits.hpp"
#include "app/schedule.hpp"
#include "app/signals.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/core/parallel.hpp"
#include "meltray/core/shell.hpp"
#include "meltray/observe/files.hpp"
#include "meltray/observe/pool.hpp"
#include "meltray/observe/version.hpp"
#include "meltray/scene/body_bounds.hpp"
#include "meltray/scene/case_file.hpp"

namespace meltray::app {
namespace fs = std::filesystem;
namespace {

/// Bytes of a state without its particles: hits of the light, counters, the file's own tables.
constexpr std::size_t kStateBesides = 1 << 20;

bool same_or_before(double a, double b) {
  return a <= b + kSameTime * std::abs(b);
}

/// history.csv with its header, ready for the row after `time`.
observe::LineFile open_history(const fs::path& file, double time) {
  const bool fresh = !fs::exists(file) || fs::file_size(file) == 0;
  if (!fresh) observe::cut_history(file, time * (1 + kSameTime));
  observe::LineFile lines(file);
  if (fresh) lines.append(observe::history_header());
  return lines;
}

}  // namespace

void RunState::archive(Archive& a) {
  since_row.archive(a);
  a.value("run/wall_seconds", wall_seconds);
  a.value("run/resumed", resumed);
  a.value("run/active", active);
  a.value("run/forked_from", forked_from);
  a.value("run/case_fingerprint", case_fingerprint);
}

std::string fingerprint(scene::Scene scene) {
  scene.time.end = 1;
  return fmt::format("{:016x}", observe::fnv1a(scene::case_values(scene)));
}

void write_case_file(const observe::RunFolder& folder, const scene::Scene& scene) {
  observe::replace_file(
      folder.file("case.toml"),
      fmt::format("# Meltray case file, schema 1: every key with its value. Written by meltray {}.\n{}",
                  observe::version(), scene::write_case(scene)));
}

void record_failed_start(const observe::RunFolder& folder, const std::string& case_name,
                         const std::exception& e) {
  observe::RunRecord r;
  r.case_name = case_name;
  const bool usage = dynamic_cast<const UsageError*>(&e) != nullptr;
  const bool io = dynamic_cast<const IoError*>(&e) != nullptr;
  r.outcome = usage ? "error" : io ? "io_error" : "failed";
  r.exit_code = usage ? kExitUsage : io ? kExitIo : kExitNumerical;
  r.message = e.what();
  r.threads = threads();
  observe::write_summary(folder.file("summary.json"), r, nullptr);
}

RunLoop::RunLoop(scene::Simulation& simulation, observe::RunFolder& folder, observe::CheckpointSlots& slots,
                 RunState state, Options options)
    : simulation_(simulation),
      folder_(folder),
      slots_(slots),
      state_(std::move(state)),
      options_(std::move(options)),
      log_(folder.file("log.txt")),
      history_(open_history(folder.file("history.csv"), simulation.time())),
      snapshots_(folder.path(), simulation.time() * (1 + kSameTime)),
      progress_(options_.quiet, simulation.time(), options_.end),
      began_(std::chrono::steady_clock::now()),
      start_time_(simulation.time()),
      wall_before_(state_.wall_seconds),
      scheduled_time_(simulation.time()) {
  auto rows = observe::read_history(folder.file("history.csv"));
  const auto &times = rows["time_s"], &variations = rows["density_variation"];
  if (!times.empty()) row_time_ = times.back();
  rows_ = static_cast<std::int64_t>(times.size());
  density_sum_ = std::accumulate(variations.begin(), variations.end(), 0.0);
}

double RunLoop::session_wall() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
}

bool RunLoop::reached(double t) const {
  return same_or_before(t, simulation_.time());
}

void RunLoop::say(const std::string& text) {
  log_.info(text);
  if (options_.quiet) return;
  progress_.finish();
  fmt::print("{}\n", text);
  std::fflush(stdout);
}

void RunLoop::warn(const std::string& text) {
  warnings_.push_back(text);
  log_.warn(text);
  progress_.finish();
  fmt::print(stderr, "meltray: warning: {}\n", text);
}

/// Says once that capillary or pool have come to where the workpiece was cropped: depths and widths then are
/// those of the block.
void RunLoop::warn_of_ends(const observe::HistoryRow& row) {
  const scene::Domain& domain = simulation_.scene().domain;
  if (warned_of_ends_ || !simulation_.scene().laser) return;
  double bottom = domain.max[2], width = 0;
  for (const scene::Body& body : domain.bodies) {
    const scene::Bounds ends = scene::bounds_of(body);
    bottom = std::min(bottom, std::max(ends.min[2], domain.min[2]));
    width = std::max(width, std::min(ends.max[1], domain.max[1]) - std::max(ends.min[1], domain.min[1]));
  }
  const double near = 1.5 * domain.spacing;
  const bool deep = std::max(row.capillary_depth, row.pool_depth) > -bottom - near,
             wide = domain.dimension == 3 && row.pool_width > width - near;
  if (!deep && !wide) return;
  warned_of_ends_ = true;
  warn(fmt::format(
      "{} at the {} of the bodies at t = {:.6g} ms: its size is theirs from now on; larger bodies",
      row.capillary_depth > -bottom - near ? "the capillary is" : "the melt is", deep ? "bottom" : "sides",
      1e3 * row.time));
}

int RunLoop::run() {
  try {
    start();
    while (!reached(options_.end)) {
      advance();
      if (const int signal = requested_signal(); signal != 0 && !reached(options_.end))
        return stop_by_signal(signal);
    }
    return finish();
  } catch (const NumericalFailure& e) {
    record_failure(e.what());
    if (checkpoint_time_ < 0)
      throw NumericalFailure(
          fmt::format("{}\nno state could be saved in {}", e.what(), folder_.path().string()));
    throw NumericalFailure(fmt::format(
        "{}\nstate saved in {} (t = {:.9g} s); go on from it with other settings:\n  meltray resume {} --set "
        "KEY=VALUE --out DIR",
        e.what(), folder_.path().string(), checkpoint_time_, shell_word(folder_.path().string())));
  } catch (const IoError& e) {
    record_io_error(e.what());
    throw;
  } catch (const fs::filesystem_error& e) {
    record_io_error(e.what());
    throw;
  } catch (const std::exception& e) {
    progress_.finish();
    write_summary("error", kExitNumerical, e.what());
    throw;
  }
}

void RunLoop::start() {
  folder_.reserve_space();
  log_.info(fmt::format("meltray {}, {} threads, case {}, log schema 1", observe::version(), threads(),
                        options_.case_name));
  if (!state_.forked_from.empty()) log_.info("forked from " + state_.forked_from);
  for (const auto& term : simulation_.terms())
    log_.info(fmt::format("term {}: {}{}", term.name, term.active ? "" : "off, ", term.partition));
  say(fmt::format("run folder {}", folder_.path().string()));
  for (const auto& text : doubtful_settings(simulation_.scene())) warn("hardly meant: " + text);
  for (const auto& text : beyond_known_limits(simulation_.scene()))
    warn("beyond what validation/studies found stable: " + text);
  say(fmt::format("{} from t = {:.6g} ms to {:.6g} ms", options_.case_name, 1e3 * start_time_,
                  1e3 * options_.end));
  write_summary("running", 0);
  if (snapshots_.count() == 0) write_snapshot();
  if (row_time_ < 0 && start_time_ > 0)
    warn(fmt::format("{} was missing or empty: it begins at t = {:.6g} ms",
                     folder_.file("history.csv").string(), 1e3 * start_time_));
  if (row_time_ < 0) write_row();
}

void RunLoop::advance() {
  const auto& output = simulation_.scene().output;
  const double t = simulation_.time();
  const double row = next_multiple(t, output.interval);
  const double snapshot = next_multiple(t, output.snapshot_interval);
  const double checkpoint = next_multiple(t, output.checkpoint_interval);
  const auto step = simulation_.step(std::min({options_.end, row, snapshot, checkpoint}));
  state_.since_row.add(step);
  state_.active = static_cast<std::int64_t>(simulation_.active_count());
  progress_.step(step, simulation_.counters().steps, simulation_.liquid_count());
  if (reached(snapshot)) write_snapshot();
  if (reached(row)) write_row();
  if (reached(checkpoint)) write_checkpoint(true);
}

int RunLoop::finish() {
  const double t = simulation_.time();
  if (snapshots_.last_time() < t * (1 - kSameTime)) write_snapshot();
  if (row_time_ < t * (1 - kSameTime)) write_row();
  if (checkpoint_time_ < t) write_checkpoint(false);
  write_seam();
  const bool whole = same_or_before(simulation_.scene().time.end, t);
  write_summary(whole ? "finished" : "stopped", kExitOk);
  folder_.release_space();
  say(fmt::format("{} at t = {:.6g} ms after {} in {}", whole ? "finished" : "stopped", 1e3 * t,
                  observe::clock_text(session_wall()), folder_.path().string()));
  return kExitOk;
}

int RunLoop::stop_by_signal(int signal) {
  const int code = signal == SIGINT ? kExitInterrupted : kExitTerminated;
  const char* name = signal == SIGINT ? "interrupted" : "terminated";
  if (checkpoint_time_ < simulation_.time()) write_checkpoint(false);
  write_seam();
  write_summary(name, code);
  folder_.release_space();
  const std::string folder = shell_word(folder_.path().string());
  say(fmt::format("{} at t = {:.6g} ms, checkpoint written; go on with\n  meltray resume {}", name,
                  1e3 * simulation_.time(), folder));
  if (simulation_.scene().output.checkpoint_interval > 0 && scheduled_time_ < simulation_.time())
    say(fmt::format(
        "which goes back to t = {:.6g} ms, where the uninterrupted run can be followed; on from here:\n"
        "  meltray resume {} --out DIR",
        1e3 * scheduled_time_, folder));
  return code;
}

void RunLoop::record_failure(const std::string& message) {
  progress_.finish();
  log_.error(message);
  try {
    if (checkpoint_time_ < simulation_.time()) write_checkpoint(false);
    if (snapshots_.last_time() < simulation_.time()) write_snapshot();
    write_seam();
  } catch (const std::exception& e) {
    log_.error(e.what());
  }
  write_summary("failed", kExitNumerical, message);
  folder_.release_space();
}

void RunLoop::record_io_error(const std::string& message) {
  progress_.finish();
  log_.error(message);
  folder_.release_space();
  try {
    write_summary("io_error", kExitIo, message);
  } catch (const std::exception& e) {
    fmt::print(stderr, "meltray: summary.json could not be written either: {}\n", e.what());
  }
}

void RunLoop::write_row() {
  const auto timer = simulation_.timers().measure(Part::observe);
  const auto row = observe::measure(simulation_, state_.since_row);
  history_.append(observe::history_line(row));
  if (row.density_variation > scene::DensityVariation::kAllowed && !warned_of_density_) {
    warned_of_density_ = true;
    warn(
        fmt::format("density varies by {:.1f} % at t = {:.6g} ms, more than {:.0f} %: raise "
                    "flow.sound_speed_m_s (now {:g} m/s); the step shrinks with its inverse",
                    100 * row.density_variation, 1e3 * row.time, 100 * scene::DensityVariation::kAllowed,
                    simulation_.scene().flow.sound_speed));
  }
  warn_of_ends(row);
  row_time_ = row.time;
  density_sum_ += row.density_variation;
  ++rows_;
  memory_ = simulation_.memory();
  state_.since_row = {};
  progress_.row(row);
}

void RunLoop::write_snapshot() {
  const auto timer = simulation_.timers().measure(Part::observe);
  snapshots_.write(simulation_.particles(),
                   {simulation_.time(), simulation_.scene().domain.spacing, simulation_.scene().title,
                    simulation_.beam(), &simulation_.on_surface()});
}

void RunLoop::write_seam() const {
  std::string text = "x_m,depth_m,width_m,top_m,particles,schema_version\n";
  for (const auto& s : observe::measure_seam(simulation_.particles(), simulation_.scene().domain.spacing))
    text += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{},1\n", s.x, s.depth, s.width, s.top, s.particles);
  observe::replace_file(folder_.file("seam.csv"), text);
}

void RunLoop::write_checkpoint(bool scheduled) {
  const auto timer = simulation_.timers().measure(Part::observe);
  history_.sync();  // a checkpoint vouches for the rows before it
  state_.wall_seconds = wall_before_ + session_wall();
  observe::CheckpointHeader header;
  header.version = observe::version();
  header.time = simulation_.time();
  header.step = simulation_.counters().steps;
  header.scheduled = scheduled;
  header.expected_bytes = simulation_.particles().bytes() + kStateBesides;
  slots_.write(header, [&](Archive& a) {
    simulation_.archive(a);
    state_.archive(a);
  });
  checkpoint_time_ = header.time;
  if (scheduled) scheduled_time_ = header.time;
  log_.info(fmt::format("checkpoint at t = {:.9g} s, step {}", header.time, header.step));
  if (scheduled) {
    write_seam();
    write_summary("running", 0);
  }
}

void RunLoop::write_summary(const std::string& outcome, int exit_code, const std::string& message) {
  observe::RunRecord r;
  r.case_name = options_.case_name;
  r.outcome = outcome;
  r.message = message;
  r.exit_code = exit_code;
  r.target_time = options_.end;
  r.session_wall = session_wall();
  r.wall_seconds = wall_before_ + r.session_wall;
  r.session_start = start_time_;
  r.resumed = static_cast<int>(state_.resumed);
  r.active = state_.active;
  r.memory = memory_;
  r.forked_from = state_.forked_from;
  r.checkpoint_time = checkpoint_time_;
  r.threads = threads();
  r.warnings = warnings_;
  r.mean_density_variation = rows_ > 0 ? density_sum_ / static_cast<double>(rows_) : 0;
  observe::write_summary(folder_.file("summary.json"), r, &simulation_);
}

}  // namespace meltray::app
