// SPDX-License-Identifier: MIT
#include "meltray/observe/run_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>
#include <utility>

#include "meltray/core/errors.hpp"
#include "meltray/core/shell.hpp"
#include "meltray/observe/files.hpp"
#include "meltray/observe/version.hpp"

namespace meltray::observe {
namespace fs = std::filesystem;
namespace {

constexpr const char* kMarker = ".meltray-run";
constexpr const char* kReserve = ".reserve";
constexpr int kMarkerSchema = 1;
/// All that a run writes.
constexpr const char* kOurs[] = {"case.toml", "history.csv",     "summary.json",    "seam.csv", "log.txt",
                                 "particles", "checkpoint-a.h5", "checkpoint-b.h5", "plots",    kReserve};

std::string random_id() {
  std::random_device device;
  return fmt::format("{:08x}{:08x}", device(), device());
}

std::string resume_hint(const fs::path& path) {
  return fmt::format("meltray resume {}", shell_word(path.string()));
}

/// Holds the lock of the marker file, or throws.
int lock_marker(const fs::path& path) {
  const fs::path marker = path / kMarker;
  // A read-only folder is refused here already, before a run starts in it.
  const int fd = ::open(marker.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (fd < 0) throw IoError(fmt::format("{}: cannot open: {}", marker.string(), std::strerror(errno)));
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    ::close(fd);
    if (error == EWOULDBLOCK)
      throw UsageError(fmt::format("{}: another meltray process works in this folder", path.string()));
    throw IoError(fmt::format("{}: cannot lock: {}", marker.string(), std::strerror(error)));
  }
  return fd;
}

/// The marker is written in place: a rename would take the locked file away.
std::string write_marker(const fs::path& path, int fd) {
  const std::string id = random_id();
  const nlohmann::ordered_json marker = {{"schema_version", kMarkerSchema},
                                         {"what", "meltray run folder"},
                                         {"run_id", id},
                                         {"version", version()}};
  const std::string text = marker.dump(1) + "\n";
  if (::ftruncate(fd, 0) != 0 ||
      ::pwrite(fd, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size()) || ::fsync(fd) != 0)
    throw IoError(fmt::format("{}: cannot write: {}", (path / kMarker).string(), std::strerror(errno)));
  return id;
}

void make_directory(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw IoError(fmt::format("{}: cannot make the folder: {}", path.string(), error.message()));
}

/// runs/<name>, runs/<name>-002, ...: the first that this call makes, so two processes never take the same.
fs::path make_default(const fs::path& runs, const std::string& name) {
  make_directory(runs);
  for (int n = 1; n < 100000; ++n) {
    const fs::path path = runs / (n == 1 ? name : fmt::format("{}-{:03}", name, n));
    std::error_code error;
    if (fs::create_directory(path, error)) return path;
    if (error && !fs::exists(path))
      throw IoError(fmt::format("{}: cannot make the folder: {}", path.string(), error.message()));
  }
  throw UsageError(fmt::format("{}: too many runs of this name; use --out", runs.string()));
}

void empty_out(const fs::path& path) {
  for (const char* name : kOurs) {
    std::error_code error;
    fs::remove_all(path / name, error);
    if (error) throw IoError(fmt::format("{}: cannot remove: {}", (path / name).string(), error.message()));
  }
}

void check_explicit(const fs::path& path, bool overwrite, bool fork) {
  if (!fs::exists(path)) return;
  if (!fs::is_directory(path)) throw UsageError(fmt::format("--out {}: not a folder", path.string()));
  if (fs::is_empty(path)) return;
  if (!is_run_folder(path))
    throw UsageError(fmt::format(
        "--out {}: not empty and not a run folder of meltray: left alone; choose another", path.string()));
  if (overwrite) return;
  if (fork)
    throw UsageError(fmt::format("--out {}: holds a run; choose another for the fork", path.string()));
  const std::string outcome = recorded_outcome(path);
  if (!is_finished(outcome))
    throw UsageError(
        fmt::format("--out {}: holds an unfinished run; continue it with\n  {}\nor replace it with "
                    "--overwrite",
                    path.string(), resume_hint(path)));
  throw UsageError(fmt::format(
      "--out {}: holds a finished run; replace it with --overwrite or choose another", path.string()));
}

}  // namespace

RunFolder::RunFolder(fs::path path, int lock, std::string run_id)
    : path_(std::move(path)), lock_(lock), run_id_(std::move(run_id)) {}

RunFolder::RunFolder(RunFolder&& other) noexcept
    : path_(std::move(other.path_)),
      lock_(std::exchange(other.lock_, -1)),
      run_id_(std::move(other.run_id_)) {}

RunFolder::~RunFolder() {
  if (lock_ >= 0) ::close(lock_);
}

RunFolder RunFolder::create(const Options& options) {
  fs::path path;
  if (options.out) {
    path = *options.out;
    check_explicit(path, options.overwrite, options.fork);
    make_directory(path);
  } else {
    path = make_default(options.runs, options.case_name);
  }
  RunFolder folder(path, lock_marker(path), "");
  empty_out(path);
  folder.run_id_ = write_marker(path, folder.lock_);
  make_directory(path / "particles");
  return folder;
}

RunFolder RunFolder::open(const fs::path& path) {
  if (!fs::is_directory(path)) throw UsageError(fmt::format("{}: no such run folder", path.string()));
  if (!is_run_folder(path))
    throw UsageError(fmt::format("{}: not a run folder of meltray (no {})", path.string(), kMarker));
  RunFolder folder(path, lock_marker(path), "");
  const auto marker = nlohmann::json::parse(read_text(path / kMarker), nullptr, false);
  if (!marker.is_object() || !marker.contains("run_id") || !marker["run_id"].is_string())
    throw UsageError(fmt::format("{}: damaged marker", (path / kMarker).string()));
  folder.run_id_ = marker["run_id"];
  make_directory(path / "particles");
  return folder;
}

void RunFolder::reserve_space() const {
  replace_file(path_ / kReserve, std::string(65536, ' '));
}

void RunFolder::release_space() const {
  std::error_code ignored;
  fs::remove(path_ / kReserve, ignored);
}

bool is_run_folder(const fs::path& path) {
  return fs::exists(path / kMarker);
}

nlohmann::json recorded_summary(const fs::path& run_folder) {
  const fs::path file = run_folder / "summary.json";
  if (!fs::exists(file)) return nlohmann::json::object();
  auto summary = nlohmann::json::parse(read_text(file), nullptr, false);
  return summary.is_object() ? summary : nlohmann::json::object();
}

std::string recorded_outcome(const fs::path& run_folder) {
  return recorded_summary(run_folder).value("outcome", "");
}

double recorded_time(const fs::path& run_folder) {
  return recorded_summary(run_folder).value("time_s", 0.0);
}

std::string recorded_case(const fs::path& run_folder) {
  return recorded_summary(run_folder).value("case", fs::absolute(run_folder).filename().string());
}

bool is_finished(const std::string& outcome) {
  return outcome == "finished";
}

}  // namespace meltray::observe
