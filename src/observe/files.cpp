// SPDX-License-Identifier: MIT
#include "meltray/observe/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "meltray/core/errors.hpp"

namespace meltray::observe {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(std::string_view doing, const fs::path& path, int error) {
  throw IoError(fmt::format("{}: cannot {}: {}", path.string(), doing, std::strerror(error)));
}

class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

/// 0, or the errno of the failure.
int write_all(int fd, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t n = ::write(fd, data, size);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    data += n;
    size -= static_cast<std::size_t>(n);
  }
  return 0;
}

void sync_directory(const fs::path& directory) {
  Descriptor d(directory.empty() ? fs::path(".") : directory, O_RDONLY | O_DIRECTORY);
  if (d.get() >= 0) ::fsync(d.get());  // some file systems cannot sync a directory: the rename still holds
}

}  // namespace

void replace_file(const fs::path& path, std::initializer_list<std::span<const std::byte>> pieces) {
  fs::path part = path;
  part += ".part";
  Descriptor file(part, O_WRONLY | O_CREAT | O_TRUNC);
  if (file.get() < 0) fail("create", part, errno);
  int error = 0;
  for (const auto bytes : pieces)
    if (error == 0) error = write_all(file.get(), reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (error == 0 && ::fsync(file.get()) != 0) error = errno;
  if (::close(file.release()) != 0 && error == 0) error = errno;
  if (error == 0 && ::rename(part.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(part.c_str());
    fail("write", path, error);
  }
  sync_directory(path.parent_path());
}

void replace_file(const fs::path& path, std::span<const std::byte> bytes) {
  replace_file(path, {bytes});
}

void replace_file(const fs::path& path, std::string_view text) {
  replace_file(path, std::as_bytes(std::span(text.data(), text.size())));
}

void write_file(const fs::path& path, std::string_view text) {
  Descriptor file(path, O_WRONLY | O_CREAT | O_TRUNC);
  if (file.get() < 0) fail("create", path, errno);
  if (const int error = write_all(file.get(), text.data(), text.size())) fail("write", path, error);
  if (::close(file.release()) != 0) fail("write", path, errno);
}

void check_writable(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) fail("write", path, EISDIR);
  const bool there = fs::exists(path, ignored);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  // The slash behind the folder's name: a file in its place is refused.
  const fs::path& needed = there ? path : folder / "";
  if (::access(needed.c_str(), there ? W_OK : W_OK | X_OK) != 0) fail("write", path, errno);
}

std::vector<std::byte> read_bytes(const fs::path& path) {
  Descriptor file(path, O_RDONLY);
  if (file.get() < 0) fail("open", path, errno);
  std::vector<std::byte> bytes;
  std::size_t used = 0;
  std::error_code ignored;
  const auto size = fs::file_size(path, ignored);
  bytes.resize(ignored ? 4096 : static_cast<std::size_t>(size) + 1);
  for (;;) {
    if (used == bytes.size()) bytes.resize(2 * bytes.size());
    const ssize_t n = ::read(file.get(), bytes.data() + used, bytes.size() - used);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("read", path, errno);
    if (n == 0) break;
    used += static_cast<std::size_t>(n);
  }
  bytes.resize(used);
  return bytes;
}

std::string read_text(const fs::path& path) {
  const auto bytes = read_bytes(path);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::uint64_t fnv1a(std::span<const std::byte> bytes, std::uint64_t start) {
  std::uint64_t hash = start;
  for (const std::byte b : bytes) hash = (hash ^ static_cast<std::uint64_t>(b)) * 0x100000001b3ULL;
  return hash;
}

std::uint64_t fnv1a(std::string_view text) {
  return fnv1a(std::as_bytes(std::span(text.data(), text.size())));
}

LineFile::LineFile(const fs::path& path) : path_(path) {
  Descriptor file(path, O_WRONLY | O_CREAT | O_APPEND);
  if (file.get() < 0) fail("open", path, errno);
  descriptor_ = file.release();
}

LineFile::~LineFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

LineFile::LineFile(LineFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

LineFile& LineFile::operator=(LineFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

void LineFile::append(std::string_view line) {
  const std::string text = fmt::format("{}\n", line);
  if (const int error = write_all(descriptor_, text.data(), text.size())) fail("write", path_, error);
}

void LineFile::sync() {
  if (descriptor_ >= 0 && ::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS)
    fail("sync", path_, errno);
}

}  // namespace meltray::observe
