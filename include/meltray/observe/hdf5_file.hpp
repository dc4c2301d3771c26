// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meltray::observe {

/// Builds an HDF5 file in memory. Nothing touches the disk before replace_file() writes the finished image,
/// so that a full disk shows as an ordinary write error and never as a half-written file. Names may contain
/// '/'.
class Hdf5Writer {
 public:
  /// compressed: chunks with the shuffle filter and gzip level 1.
  enum class Packing { plain, compressed };

  /// `expected`: bytes for which memory is taken at once, where they are known; without, it grows piece by
  /// piece.
  explicit Hdf5Writer(std::size_t expected = 0);
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  /// One-dimensional array, or rows of `columns` entries.
  void dataset(std::string_view name, std::span<const double> v, std::size_t columns = 1,
               Packing packing = Packing::plain);
  void dataset(std::string_view name, std::span<const float> v, std::size_t columns = 1,
               Packing packing = Packing::plain);
  void dataset(std::string_view name, std::span<const std::uint8_t> v, std::size_t columns = 1,
               Packing packing = Packing::plain);
  void dataset(std::string_view name, std::span<const std::int32_t> v, std::size_t columns = 1,
               Packing packing = Packing::plain);
  void scalar(std::string_view name, double v);
  void scalar(std::string_view name, std::int64_t v);
  void scalar(std::string_view name, std::string_view v);

  /// Attribute of a dataset, or of the file when `object` is "/".
  void attribute(std::string_view object, std::string_view name, double v);
  void attribute(std::string_view object, std::string_view name, std::int64_t v);
  void attribute(std::string_view object, std::string_view name, std::string_view v);
  void attribute(std::string_view object, std::string_view name, std::span<const double> v);

  /// The bytes of the file, in place: until the next call of another member.
  std::span<const std::byte> image();

 private:
  std::int64_t file_;
};

/// Reads an HDF5 file from memory. `label` is the name of the file in messages. Throws UsageError, naming the
/// file and what is wrong, where it is not HDF5 or does not hold what is asked for.
class Hdf5Reader {
 public:
  Hdf5Reader(std::span<const std::byte> image, std::string label);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  bool has(std::string_view name) const;
  void dataset(std::string_view name, std::vector<double>& v) const;
  void dataset(std::string_view name, std::vector<float>& v) const;
  void dataset(std::string_view name, std::vector<std::uint8_t>& v) const;
  void dataset(std::string_view name, std::vector<std::int32_t>& v) const;
  void scalar(std::string_view name, double& v) const;
  void scalar(std::string_view name, std::int64_t& v) const;
  void scalar(std::string_view name, std::string& v) const;
  double attribute_double(std::string_view object, std::string_view name) const;
  std::int64_t attribute_int(std::string_view object, std::string_view name) const;
  /// Number of entries of a dataset (all dimensions).
  std::size_t entries(std::string_view name) const;

 private:
  std::string label_;
  std::int64_t file_;
};

}  // namespace meltray::observe
