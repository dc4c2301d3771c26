// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meltray::observe {

/// Replaces `path` in one step: written beside it (".part"), synced, renamed, directory synced. A kill or a
/// full disk at any moment leaves either the old or the new content. Throws IoError with file and reason.
void replace_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
void replace_file(const std::filesystem::path& path, std::string_view text);
/// The same with a content that stands in several places, one after the other.
void replace_file(const std::filesystem::path& path,
                  std::initializer_list<std::span<const std::byte>> pieces);

/// Writes `text` in place, so that `path` may also be a device such as /dev/stdout. Throws IoError.
void write_file(const std::filesystem::path& path, std::string_view text);
/// Throws IoError where write_file() could not write: to be known before the work whose result goes there.
void check_writable(const std::filesystem::path& path);

/// Whole file. Throws IoError when it cannot be read.
std::vector<std::byte> read_bytes(const std::filesystem::path& path);
std::string read_text(const std::filesystem::path& path);

/// FNV-1a, 64 bit. Each byte enters by an invertible operation, so two inputs that differ in one byte never
/// have the same value.
std::uint64_t fnv1a(std::span<const std::byte> bytes, std::uint64_t start = 0xcbf29ce484222325ULL);
std::uint64_t fnv1a(std::string_view text);

/// Appends whole lines to a file. What was not acknowledged by sync() may be lost by a power cut, nothing
/// else.
class LineFile {
 public:
  LineFile() = default;
  explicit LineFile(const std::filesystem::path& path);
  ~LineFile();
  LineFile(LineFile&& other) noexcept;
  LineFile& operator=(LineFile&& other) noexcept;
  /// Appends `line` and a newline. Throws IoError.
  void append(std::string_view line);
  void sync();

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace meltray::observe
