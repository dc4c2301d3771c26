// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "meltray/observe/files.hpp"
#include "meltray/observe/hdf5_file.hpp"
#include "meltray/observe/snapshots.hpp"
#include "unit/observe/temporary_folder.hpp"

using namespace meltray;
using namespace meltray::observe;
namespace fs = std::filesystem;

namespace {

Particles five(int dim) {
  Particles p;
  p.dim = dim;
  for (int i = 0; i < 5; ++i) {
    p.add(dim == 3 ? Vec3(i, 10 * i, 100 * i) : Vec3(i, 100 * i, 0), 1e5, 1, 1, i == 0 ? 1 : 0);
    p.temperature.back() = 300 + i;
    p.v[dim - 1].back() = -i;  // z
  }
  p.flags[1] |= kRemoved;
  p.flags[2] |= kResolidified;
  p.phase[3] = 1;
  return p;
}

}  // namespace

TEST_CASE("a snapshot holds the particles that are neither wall nor removed") {
  TemporaryFolder t;
  const int dim = GENERATE(2, 3);
  const Particles p = five(dim);
  fs::create_directory(t / "particles");
  Snapshots out(t.path(), -1);
  const std::vector<std::uint8_t> surface = {1, 1, 0, 1, 0};
  out.write(p, {0.25, 1e-4, "t", nullptr, &surface});

  const Hdf5Reader in(read_bytes(t / "particles/000000.h5"), "s");
  CHECK(in.attribute_double("/", "time_s") == 0.25);
  CHECK(in.attribute_int("/", "schema_version") == kSnapshotSchema);
  std::vector<std::int32_t> id;
  in.dataset("id", id);
  CHECK(id == std::vector<std::int32_t>{2, 3, 4});
  std::vector<float> x, v;
  in.dataset("position", x);
  in.dataset("velocity", v);
  REQUIRE(x.size() == 9);
  CHECK(x[3] == 3);
  CHECK(x[4] == (dim == 3 ? 30 : 0));
  CHECK(x[5] == 300);
  CHECK(v[5] == -3);
  std::vector<std::uint8_t> u;
  in.dataset("phase", u);
  CHECK(u == std::vector<std::uint8_t>{0, 1, 0});
  in.dataset("resolidified", u);
  CHECK(u == std::vector<std::uint8_t>{1, 0, 0});
  in.dataset("on_surface", u);
  CHECK(u == std::vector<std::uint8_t>{0, 1, 0});
}

TEST_CASE("a scene with elastic solid writes the stress after von Mises") {
  TemporaryFolder t;
  const int dim = GENERATE(2, 3);
  Particles p = five(dim);
  for (int c = 0; c < symmetric_count(dim); ++c) p.stress[c].assign(p.size(), 0.0);
  p.stress[1][2] = 2;  // shear alone: sqrt(3) times it
  // A tension of 3 along x leaves the deviator (2, -1, -1); in plane strain its y part is not stored.
  p.stress[0][3] = 2;
  p.stress[symmetric_count(dim) - 1][3] = -1;
  if (dim == 3) p.stress[3][3] = -1;
  fs::create_directory(t / "particles");
  Snapshots out(t.path(), -1);
  out.write(p, {0, 1e-4, "t", nullptr, nullptr});
  std::vector<float> stress;
  Hdf5Reader(read_bytes(t / "particles/000000.h5"), "s").dataset("von_mises_stress", stress);
  REQUIRE(stress.size() == 3);
  CHECK(stress[0] == Approx(2 * std::sqrt(3.0)));
  CHECK(stress[1] == Approx(3));
  CHECK(stress[2] == 0);
  CHECK(read_text(t / "particles.xdmf").find("von_mises_stress") != std::string::npos);
}

TEST_CASE("the collection is extended on resume and forgets what comes after the checkpoint") {
  TemporaryFolder t;
  fs::create_directory(t / "particles");
  const Particles p = five(3);
  {
    Snapshots out(t.path(), -1);
    for (const double time : {0.0, 1e-3, 2e-3}) out.write(p, {time, 1e-4, "t", nullptr, nullptr});
  }
  Snapshots out(t.path(), 1.5e-3);
  CHECK(out.count() == 2);
  CHECK(out.last_time() == 1e-3);
  CHECK_FALSE(fs::exists(t / "particles/000002.h5"));
  out.write(p, {2.5e-3, 1e-4, "t", nullptr, nullptr});
  CHECK(fs::exists(t / "particles/000002.h5"));
  const std::string xdmf = read_text(t / "particles.xdmf");
  std::size_t grids = 0;
  for (auto at = xdmf.find("<Time "); at != std::string::npos; at = xdmf.find("<Time ", at + 1)) ++grids;
  CHECK(grids == 3);
  CHECK(xdmf.find("<Time Value=\"0.0025\"/>") != std::string::npos);
  CHECK(xdmf.find(">particles/000001.h5:/position<") != std::string::npos);
  CHECK(xdmf.find(t.path().string()) == std::string::npos);
}
