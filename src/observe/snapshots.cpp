// SPDX-License-Identifier: MIT
#include "meltray/observe/snapshots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "meltray/core/errors.hpp"
#include "meltray/observe/files.hpp"
#include "meltray/observe/hdf5_file.hpp"
#include "meltray/observe/pool.hpp"

namespace meltray::observe {
namespace fs = std::filesystem;
namespace {

/// A field of a snapshot as it appears in the XDMF file.
struct Field {
  const char* name;
  const char* unit;
  const char* type;  ///< XDMF number type
  int bytes;
  bool vector;
};
constexpr Field kFields[] = {{"velocity", "m/s", "Float", 4, true},
                             {"temperature", "K", "Float", 4, false},
                             {"pressure", "Pa", "Float", 4, false},
                             {"phase", "0 solid, 1 liquid", "UChar", 1, false},
                             {"resolidified", "flag", "UChar", 1, false},
                             {"on_surface", "flag", "UChar", 1, false},
                             {"id", "index", "Int", 4, false}};
/// Of scenes with elastic solid, besides.
constexpr Field kStress = {"von_mises_stress", "Pa", "Float", 4, false};

/// sqrt(3/2 S : S); in two dimensions, plane strain, S_yy = -S_xx - S_zz.
float von_mises(const Particles& p, std::size_t i) {
  double square = 0, trace = 0;
  int n = 0;
  for (int a = 0; a < p.dim; ++a)
    for (int b = a; b < p.dim; ++b, ++n) {
      const double s = p.stress[n][i];
      square += a == b ? s * s : 2 * s * s;
      trace += a == b ? s : 0.0;
    }
  if (p.dim == 2) square += trace * trace;
  return static_cast<float>(std::sqrt(1.5 * square));
}

void write_beam(Hdf5Writer& out, const laser::Beam& beam, double t) {
  const Vec3 focus = beam.focus(t), axis = beam.axis();
  out.attribute("/", "beam_focus_m", std::span<const double>(focus.data(), 3));
  out.attribute("/", "beam_axis", std::span<const double>(axis.data(), 3));
  out.attribute("/", "beam_focal_diameter_m", beam.spec().focal_diameter);
  out.attribute("/", "beam_rayleigh_length_m", beam.spec().rayleigh_length);
  out.attribute("/", "beam_power_w", beam.power(t));
}

std::string attribute_text(const Field& f, const std::string& file, std::size_t n) {
  return fmt::format(
      "    <Attribute Name=\"{0}\" AttributeType=\"{1}\" Center=\"Node\">\n"
      "     <DataItem Dimensions=\"{2}{3}\" NumberType=\"{4}\" Precision=\"{5}\" "
      "Format=\"HDF\">{6}:/{0}</DataItem>\n"
      "    </Attribute>\n",
      f.name, f.vector ? "Vector" : "Scalar", n, f.vector ? " 3" : "", f.type, f.bytes, file);
}

std::string grid_text(const std::string& file, double time, std::size_t n, bool stress) {
  std::string text = fmt::format(
      "   <Grid Name=\"particles\" GridType=\"Uniform\">\n"
      "    <Time Value=\"{}\"/>\n"
      "    <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\"/>\n"
      "    <Geometry GeometryType=\"XYZ\">\n"
      "     <DataItem Dimensions=\"{} 3\" NumberType=\"Float\" Precision=\"4\" "
      "Format=\"HDF\">{}:/position</DataItem>\n"
      "    </Geometry>\n",
      time, n, n, file);
  for (const Field& f : kFields) text += attribute_text(f, file, n);
  if (stress) text += attribute_text(kStress, file, n);
  return text + "   </Grid>\n";
}

}  // namespace

Snapshots::Snapshots(fs::path run_folder, double time) : folder_(std::move(run_folder)) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& e : fs::directory_iterator(folder_ / "particles", error)) {
    if (e.path().extension() == ".h5") files.push_back(e.path());
    if (e.path().extension() == ".part") fs::remove(e.path(), error);
  }
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    bool keep = false;
    double t = 0;
    std::size_t n = 0;
    try {
      const Hdf5Reader in(read_bytes(file), file.string());
      t = in.attribute_double("/", "time_s");
      n = in.entries("id");
      keep = t <= time;
    } catch (const UsageError&) {
      // Not readable as one of ours: it is written again when the run gets there.
    }
    if (keep)
      entries_.push_back({"particles/" + file.filename().string(), t, n});
    else
      fs::remove(file, error);
  }
  if (!entries_.empty()) next_ = std::atoi(fs::path(entries_.back().file).stem().c_str()) + 1;
}

void Snapshots::write(const Particles& p, const SnapshotInfo& info) {
  has_stress_ = !p.stress[0].empty();
  std::vector<std::int32_t> id;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (is_material(p, i)) id.push_back(static_cast<std::int32_t>(i));
  Hdf5Writer out;
  // One field at a time: a copy of all would be as large as the particles themselves.
  const auto write = [&]<class T>(const char* name, std::size_t columns, T, auto&& value) {
    std::vector<T> v;
    v.reserve(columns * id.size());
    for (const std::int32_t i : id)
      for (std::size_t c = 0; c < columns; ++c)
        v.push_back(static_cast<T>(value(static_cast<std::size_t>(i), c)));
    out.dataset(name, v, columns, Hdf5Writer::Packing::compressed);
  };
  write("position", 3, 0.0f, [&](std::size_t i, std::size_t c) { return position(p, i)[c]; });
  write("velocity", 3, 0.0f, [&](std::size_t i, std::size_t c) { return velocity(p, i)[c]; });
  write("temperature", 1, 0.0f, [&](std::size_t i, std::size_t) { return p.temperature[i]; });
  write("pressure", 1, 0.0f, [&](std::size_t i, std::size_t) { return p.pressure[i]; });
  write("phase", 1, std::uint8_t{}, [&](std::size_t i, std::size_t) { return p.phase[i]; });
  write("resolidified", 1, std::uint8_t{},
        [&](std::size_t i, std::size_t) { return p.has(i, kResolidified); });
  write("on_surface", 1, std::uint8_t{}, [&](std::size_t i, std::size_t) {
    return info.on_surface != nullptr && i < info.on_surface->size() ? (*info.on_surface)[i] : 0;
  });
  out.dataset("id", id, 1, Hdf5Writer::Packing::compressed);
  if (has_stress_) {
    write(kStress.name, 1, 0.0f, [&](std::size_t i, std::size_t) { return von_mises(p, i); });
    out.attribute(kStress.name, "units", std::string_view(kStress.unit));
  }
  out.attribute("position", "units", std::string_view("m"));
  for (const Field& f : kFields) out.attribute(f.name, "units", std::string_view(f.unit));
  out.attribute("/", "schema_version", std::int64_t{kSnapshotSchema});
  out.attribute("/", "title", std::string_view(info.title));
  out.attribute("/", "time_s", info.time);
  out.attribute("/", "spacing_m", info.spacing);
  out.attribute("/", "dimension", std::int64_t{p.dim});
  if (info.beam != nullptr) write_beam(out, *info.beam, info.time);

  const std::string name = fmt::format("particles/{:06}.h5", next_);
  replace_file(folder_ / name, out.image());
  ++next_;
  entries_.push_back({name, info.time, id.size()});
  write_collection();
}

void Snapshots::write_collection() const {
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n <Domain>\n"
      "  <Information Name=\"schema_version\" Value=\"{}\"/>\n"
      "  <Grid Name=\"run\" GridType=\"Collection\" CollectionType=\"Temporal\">\n",
      kSnapshotSchema);
  for (const auto& e : entries_) text += grid_text(e.file, e.time, e.particles, has_stress_);
  text += "  </Grid>\n </Domain>\n</Xdmf>\n";
  replace_file(folder_ / "particles.xdmf", text);
}

}  // namespace meltray::observe
