// SPDX-License-Identifier: MIT
#include "meltray/observe/hdf5_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <atomic>

#include "meltray/core/errors.hpp"

namespace meltray::observe {
namespace {

/// An HDF5 identifier with the function that closes it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }
  bool ok() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void silence() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

[[noreturn]] void fail_write(std::string_view what) {
  throw IoError(fmt::format("HDF5 cannot write {}", what));
}

void require(bool ok, std::string_view what) {
  if (!ok) fail_write(what);
}

constexpr hsize_t kChunkRows = 16384;

void write_array(hid_t file, std::string_view name, const void* data, hid_t type, std::size_t entries,
                 std::size_t columns, Hdf5Writer::Packing packing) {
  const hsize_t rows = entries / columns;
  const hsize_t dims[2] = {rows, columns};
  const int rank = columns == 1 ? 1 : 2;
  Handle space(H5Screate_simple(rank, dims, nullptr), H5Sclose);
  Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  require(space.ok() && links.ok() && layout.ok() && H5Pset_create_intermediate_group(links, 1) >= 0, name);
  // Without time stamps equal content makes equal files: a resumed run repeats its snapshots byte for byte.
  require(H5Pset_obj_track_times(layout, false) >= 0, name);
  if (packing == Hdf5Writer::Packing::compressed && rows > 0) {
    const hsize_t chunk[2] = {std::min(rows, kChunkRows), columns};
    require(H5Pset_chunk(layout, rank, chunk) >= 0 && H5Pset_shuffle(layout) >= 0 &&
                H5Pset_deflate(layout, 1) >= 0,
            name);
  }
  Handle set(H5Dcreate2(file, std::string(name).c_str(), type, space, links, layout, H5P_DEFAULT), H5Dclose);
  require(set.ok(), name);
  require(rows == 0 || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0, name);
}

/// Fixed-length string type; HDF5 has none of length zero.
Handle string_type(std::size_t length) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, std::max<std::size_t>(length, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  return Handle(type, H5Tclose);
}

void write_scalar(hid_t file, std::string_view name, const void* data, hid_t type) {
  Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  require(space.ok() && links.ok() && layout.ok() && H5Pset_create_intermediate_group(links, 1) >= 0 &&
              H5Pset_obj_track_times(layout, false) >= 0,
          name);
  Handle set(H5Dcreate2(file, std::string(name).c_str(), type, space, links, layout, H5P_DEFAULT), H5Dclose);
  require(set.ok() && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0, name);
}

void write_attribute(hid_t file, std::string_view object, std::string_view name, const void* data, hid_t type,
                     hid_t space) {
  Handle owner(H5Oopen(file, std::string(object).c_str(), H5P_DEFAULT), H5Oclose);
  require(owner.ok(), object);
  Handle attribute(H5Acreate2(owner, std::string(name).c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                   H5Aclose);
  require(attribute.ok() && H5Awrite(attribute, type, data) >= 0, name);
}

void write_attribute(hid_t file, std::string_view object, std::string_view name, const void* data,
                     hid_t type) {
  Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  write_attribute(file, object, name, data, type, space);
}

/// Files in memory need different names: the library takes two of one name for the same file.
std::string memory_name() {
  static std::atomic<unsigned long> count{0};
  return fmt::format("meltray-image-{}", ++count);
}

hid_t memory_access(std::size_t expected = 0) {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, std::max(expected, std::size_t{1} << 20), 0);
  return access;
}

}  // namespace

Hdf5Writer::Hdf5Writer(std::size_t expected) {
  silence();
  Handle access(memory_access(expected), H5Pclose);
  file_ = H5Fcreate(memory_name().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  require(file_ >= 0, "a file in memory");
}

Hdf5Writer::~Hdf5Writer() {
  H5Fclose(file_);
}

void Hdf5Writer::dataset(std::string_view name, std::span<const double> v, std::size_t columns,
                         Packing packing) {
  write_array(file_, name, v.data(), H5T_NATIVE_DOUBLE, v.size(), columns, packing);
}
void Hdf5Writer::dataset(std::string_view name, std::span<const float> v, std::size_t columns,
                         Packing packing) {
  write_array(file_, name, v.data(), H5T_NATIVE_FLOAT, v.size(), columns, packing);
}
void Hdf5Writer::dataset(std::string_view name, std::span<const std::uint8_t> v, std::size_t columns,
                         Packing packing) {
  write_array(file_, name, v.data(), H5T_NATIVE_UINT8, v.size(), columns, packing);
}
void Hdf5Writer::dataset(std::string_view name, std::span<const std::int32_t> v, std::size_t columns,
                         Packing packing) {
  write_array(file_, name, v.data(), H5T_NATIVE_INT32, v.size(), columns, packing);
}
void Hdf5Writer::scalar(std::string_view name, double v) {
  write_scalar(file_, name, &v, H5T_NATIVE_DOUBLE);
}
void Hdf5Writer::scalar(std::string_view name, std::int64_t v) {
  write_scalar(file_, name, &v, H5T_NATIVE_INT64);
}
void Hdf5Writer::scalar(std::string_view name, std::string_view v) {
  write_scalar(file_, name, std::string(v).c_str(), string_type(v.size()));
}

void Hdf5Writer::attribute(std::string_view object, std::string_view name, double v) {
  write_attribute(file_, object, name, &v, H5T_NATIVE_DOUBLE);
}
void Hdf5Writer::attribute(std::string_view object, std::string_view name, std::int64_t v) {
  write_attribute(file_, object, name, &v, H5T_NATIVE_INT64);
}
void Hdf5Writer::attribute(std::string_view object, std::string_view name, std::string_view v) {
  write_attribute(file_, object, name, std::string(v).c_str(), string_type(v.size()));
}
void Hdf5Writer::attribute(std::string_view object, std::string_view name, std::span<const double> v) {
  const hsize_t size = v.size();
  Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  write_attribute(file_, object, name, v.data(), H5T_NATIVE_DOUBLE, space);
}

std::span<const std::byte> Hdf5Writer::image() {
  require(H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0, "a file in memory");
  const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
  require(size > 0, "a file in memory");
  // H5Fget_file_image() would copy it; the handle of the driver for files in memory is where its buffer is.
  void* handle = nullptr;
  require(H5Fget_vfd_handle(file_, H5P_DEFAULT, &handle) >= 0 && handle != nullptr, "a file in memory");
  std::byte* const bytes = *static_cast<std::byte**>(handle);
  // What that function does besides: the file does not count as open for writing (superblock version 0).
  constexpr std::size_t kVersion = 8, kStatusFlags = 20, kStatusSize = 4;
  require(bytes[kVersion] == std::byte{0}, "a file in memory");
  std::fill_n(bytes + kStatusFlags, kStatusSize, std::byte{0});
  return {bytes, static_cast<std::size_t>(size)};
}

namespace {

[[noreturn]] void bad(const std::string& label, std::string_view what) {
  throw UsageError(fmt::format("{}: {}", label, what));
}

Handle open_dataset(hid_t file, const std::string& label, std::string_view name) {
  const hid_t id = H5Dopen2(file, std::string(name).c_str(), H5P_DEFAULT);
  if (id < 0) bad(label, fmt::format("holds no '{}'", name));
  return Handle(id, H5Dclose);
}

void check_type(hid_t stored, hid_t expected, const std::string& label, std::string_view name) {
  if (H5Tget_class(stored) != H5Tget_class(expected) || H5Tget_size(stored) != H5Tget_size(expected))
    bad(label, fmt::format("'{}' has another type than expected", name));
}

std::size_t entries_of(hid_t set) {
  Handle space(H5Dget_space(set), H5Sclose);
  const hssize_t n = H5Sget_simple_extent_npoints(space);
  return n < 0 ? 0 : static_cast<std::size_t>(n);
}

template <class T>
void read_array(hid_t file, const std::string& label, std::string_view name, hid_t type, std::vector<T>& v) {
  Handle set = open_dataset(file, label, name);
  Handle stored(H5Dget_type(set), H5Tclose);
  check_type(stored, type, label, name);
  v.resize(entries_of(set));
  if (!v.empty() && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, v.data()) < 0)
    bad(label, fmt::format("'{}' cannot be read", name));
}

template <class T>
void read_scalar(hid_t file, const std::string& label, std::string_view name, hid_t type, T& v) {
  std::vector<T> one;
  read_array(file, label, name, type, one);
  if (one.size() != 1) bad(label, fmt::format("'{}' is not a single value", name));
  v = one[0];
}

template <class T>
T read_attribute(hid_t file, const std::string& label, std::string_view object, std::string_view name,
                 hid_t type) {
  Handle attribute(
      H5Aopen_by_name(file, std::string(object).c_str(), std::string(name).c_str(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  T v{};
  if (!attribute.ok() || H5Aread(attribute, type, &v) < 0)
    bad(label, fmt::format("holds no attribute '{}'", name));
  return v;
}

}  // namespace

Hdf5Reader::Hdf5Reader(std::span<const std::byte> image, std::string label)
    : label_(std::move(label)), file_(-1) {
  silence();
  Handle access(memory_access(), H5Pclose);
  // The library copies the image, so the cast does not let it write into the caller's bytes.
  if (!image.empty() && H5Pset_file_image(access, const_cast<std::byte*>(image.data()), image.size()) >= 0)
    file_ = H5Fopen(memory_name().c_str(), H5F_ACC_RDONLY, access);
  if (file_ < 0) bad(label_, "not an HDF5 file");
}

Hdf5Reader::~Hdf5Reader() {
  H5Fclose(file_);
}

bool Hdf5Reader::has(std::string_view name) const {
  return H5Lexists(file_, std::string(name).c_str(), H5P_DEFAULT) > 0;
}
void Hdf5Reader::dataset(std::string_view name, std::vector<double>& v) const {
  read_array(file_, label_, name, H5T_NATIVE_DOUBLE, v);
}
void Hdf5Reader::dataset(std::string_view name, std::vector<float>& v) const {
  read_array(file_, label_, name, H5T_NATIVE_FLOAT, v);
}
void Hdf5Reader::dataset(std::string_view name, std::vector<std::uint8_t>& v) const {
  read_array(file_, label_, name, H5T_NATIVE_UINT8, v);
}
void Hdf5Reader::dataset(std::string_view name, std::vector<std::int32_t>& v) const {
  read_array(file_, label_, name, H5T_NATIVE_INT32, v);
}
void Hdf5Reader::scalar(std::string_view name, double& v) const {
  read_scalar(file_, label_, name, H5T_NATIVE_DOUBLE, v);
}
void Hdf5Reader::scalar(std::string_view name, std::int64_t& v) const {
  read_scalar(file_, label_, name, H5T_NATIVE_INT64, v);
}
void Hdf5Reader::scalar(std::string_view name, std::string& v) const {
  Handle set = open_dataset(file_, label_, name);
  Handle type(H5Dget_type(set), H5Tclose);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0)
    bad(label_, fmt::format("'{}' has another type than expected", name));
  v.assign(H5Tget_size(type), '\0');
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, v.data()) < 0)
    bad(label_, fmt::format("'{}' cannot be read", name));
  while (!v.empty() && v.back() == '\0') v.pop_back();
}
double Hdf5Reader::attribute_double(std::string_view object, std::string_view name) const {
  return read_attribute<double>(file_, label_, object, name, H5T_NATIVE_DOUBLE);
}
std::int64_t Hdf5Reader::attribute_int(std::string_view object, std::string_view name) const {
  return read_attribute<std::int64_t>(file_, label_, object, name, H5T_NATIVE_INT64);
}
std::size_t Hdf5Reader::entries(std::string_view name) const {
  return entries_of(open_dataset(file_, label_, name));
}

}  // namespace meltray::observe
