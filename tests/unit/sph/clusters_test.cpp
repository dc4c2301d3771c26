// SPDX-License-Identifier: MIT
#include "meltray/sph/clusters.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "unit/terms/stage_setup.hpp"

using namespace meltray;
using sph::kGroupRows;
using sph::kLanes;

namespace {

constexpr std::uint8_t kTaken = 1, kOthers = 2;

/// A rotated, jittered cube of particles of two kinds, and some spray far away.
struct Cloud {
  Patch patch;
  std::vector<std::uint8_t> kind;
  std::array<double, 3> period{};
  sph::ClusterSet rows, sources;
  sph::ClusterList list;

  Cloud(int dim, bool periodic) {
    patch.dim = dim;
    test::Noise noise(5);
    const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(0.4, Vec3::UnitZ()) * Eigen::AngleAxisd(dim == 3 ? 0.7 : 0.0, Vec3::UnitX()))
            .toRotationMatrix();
    const int n = dim == 3 ? 10 : 31;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < (dim == 3 ? n : 1); ++k) {
          Vec3 x = turn * Vec3(i, j, k);
          for (int c = 0; c < dim; ++c) x[c] += 0.4 * noise();
          add(x);
        }
    if (periodic)
      for (int c = 0; c < dim; ++c) period[c] = n;
    else
      for (int s = 0; s < 5; ++s) add(Vec3(1e4 * s, -3e3 * s, dim == 3 ? 50 * s : 0));
    rows.sort(patch, kind, kTaken, 1, period);
    sources.sort(patch, kind, kOthers, 1, period);
  }
  void add(const Vec3& x) {
    for (int c = 0; c < patch.dim; ++c) patch.x[c].push_back(x[c]);
    patch.global.push_back(patch.size());
    kind.push_back(patch.size() % 3 == 0 ? kTaken : kOthers);
  }
  double distance(Index i, Index j) const {
    double r2 = 0;
    for (int c = 0; c < patch.dim; ++c) {
      double d = patch.x[c][i] - patch.x[c][j];
      if (period[c] > 0) d -= period[c] * std::rint(d / period[c]);
      r2 += d * d;
    }
    return std::sqrt(r2);
  }
};

}  // namespace

TEST_CASE("every chosen particle has one slot, in an octet of its neighbourhood") {
  const int dim = GENERATE(2, 3);
  const Cloud cloud(dim, false);
  std::vector<int> met(cloud.patch.size(), 0);
  for (const auto* set : {&cloud.rows, &cloud.sources}) {
    CHECK(set->slots() % kLanes == 0);
    for (const Index i : set->particle())
      if (i >= 0) ++met[i];
  }
  CHECK(std::all_of(met.begin(), met.end(), [](int n) { return n == 1; }));
  // Empty slots: hardly more than half an octet a column.
  CHECK(cloud.rows.slots() + cloud.sources.slots() < 2 * cloud.patch.size());
}

TEST_CASE("lists of octets hold every pair within reach, and no octet twice or without a pair") {
  const int dim = GENERATE(2, 3);
  const bool periodic = GENERATE(false, true);
  Cloud cloud(dim, periodic);
  const double reach = 2.6;
  cloud.list.build(cloud.rows, cloud.sources, reach);
  for (Index group = 0; group < cloud.rows.groups(); ++group) {
    std::vector<Index> octets(cloud.list.octets() + cloud.list.start()[group],
                              cloud.list.octets() + cloud.list.start()[group + 1]);
    std::sort(octets.begin(), octets.end());
    REQUIRE(std::adjacent_find(octets.begin(), octets.end()) == octets.end());
    for (Index octet = 0; octet < cloud.sources.octets(); ++octet) {
      bool near = false;
      for (Index row = group * kGroupRows; row < (group + 1) * kGroupRows; ++row)
        for (Index s = octet * kLanes; s < (octet + 1) * kLanes; ++s) {
          const Index i = cloud.rows.particle()[row], j = cloud.sources.particle()[s];
          near = near || (i >= 0 && j >= 0 && cloud.distance(i, j) < reach);
        }
      REQUIRE(std::binary_search(octets.begin(), octets.end(), octet) == near);
    }
  }
}

TEST_CASE("sets without particles have empty lists") {
  Cloud cloud(3, false);
  sph::ClusterSet none;
  none.sort(cloud.patch, std::vector<std::uint8_t>(cloud.patch.size(), 0), kTaken, 1, {});
  CHECK(none.slots() == 0);
  cloud.list.build(cloud.rows, none, 2.6);
  CHECK(cloud.list.start()[cloud.rows.groups()] == 0);
  cloud.list.build(none, cloud.rows, 2.6);
  CHECK(cloud.list.start()[0] == 0);
}

TEST_CASE("fields come in the order of the slots") {
  const Cloud cloud(3, false);
  AlignedDoubles packed;
  cloud.sources.pack(cloud.patch.x[1], 7, packed);
  for (Index s = 0; s < cloud.sources.slots(); ++s) {
    const Index i = cloud.sources.particle()[s];
    CHECK(packed[s] == (i < 0 ? 7 : cloud.patch.x[1][i]));
  }
}
