// SPDX-License-Identifier: MIT
#include "meltray/sph/pairs.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "unit/terms/stage_setup.hpp"

using namespace meltray;
using meltray::test::Noise;

namespace {

enum class Arrangement { lattice, jittered, rotated };

Particles cloud(int dim, double dx, double length, Arrangement arrangement, bool periodic) {
  Particles p;
  p.dim = dim;
  const int n = static_cast<int>(std::lround(length / dx));
  Noise noise(7);
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.4, Vec3::UnitZ()) * Eigen::AngleAxisd(dim == 3 ? 0.7 : 0.0, Vec3::UnitX()))
          .toRotationMatrix();
  for (int k = 0; k < (dim == 3 ? n : 1); ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        Vec3 x = dx * Vec3(i + 0.5, j + 0.5, dim == 3 ? k + 0.5 : 0.0);
        if (arrangement == Arrangement::jittered)
          for (int c = 0; c < dim; ++c) x[c] += 0.4 * dx * noise();
        if (arrangement == Arrangement::rotated) {
          const Vec3 centre = Vec3(0.5, 0.5, dim == 3 ? 0.5 : 0.0) * length;
          x = centre + turn * (x - centre);
          bool inside = true;
          for (int c = 0; c < dim; ++c) inside = inside && x[c] > 0 && x[c] < length;
          if (!inside) continue;
        }
        if (periodic)
          for (int c = 0; c < dim; ++c) x[c] -= length * std::floor(x[c] / length);
        p.add(x, 1000, 1, 1.3 * dx);
      }
  return p;
}

double distance(const Patch& p, Index i, Index j, const std::array<double, 3>& period) {
  double r2 = 0;
  for (int c = 0; c < p.dim; ++c) {
    double d = p.x[c][i] - p.x[c][j];
    if (period[c] > 0) d -= period[c] * std::rint(d / period[c]);
    r2 += d * d;
  }
  return std::sqrt(r2);
}

std::set<Index> brute_force(const Patch& p, Index i, double radius, const std::array<double, 3>& period) {
  std::set<Index> near;
  for (Index j = 0; j < p.size(); ++j)
    if (j != i && distance(p, i, j, period) < radius) near.insert(j);
  return near;
}

std::set<Index> row(const sph::PairList& pairs, Index i) {
  std::set<Index> near;
  for (Index k = pairs.begin(i); k < pairs.end(i); ++k) near.insert(pairs.neighbour(k));
  // An entry twice in a row would be lost in the set.
  REQUIRE(static_cast<Index>(near.size()) == pairs.end(i) - pairs.begin(i));
  return near;
}

}  // namespace

TEST_CASE("rows of the pair list are the neighbours found by brute force") {
  const double dx = 1e-4;
  for (int dim : {2, 3})
    for (bool periodic : {false, true})
      for (auto arrangement : {Arrangement::lattice, Arrangement::jittered, Arrangement::rotated}) {
        CAPTURE(dim, periodic, static_cast<int>(arrangement));
        const double length = (dim == 2 ? 24 : 12) * dx;
        const Particles p = cloud(dim, dx, length, arrangement, periodic);
        const double skin = 0.25 * dx;
        const CellGrid grid(dim, Vec3::Zero(), Vec3::Constant(length), 2.6 * dx + skin,
                            {periodic, periodic, periodic && dim == 3});
        PatchSelector selector(grid, p);
        Patch patch;
        selector.select_all(p, patch);
        REQUIRE(patch.size() == static_cast<Index>(p.size()));
        sph::PairList pairs;
        pairs.build(patch, grid, skin, std::vector<std::uint8_t>(patch.size(), 1));
        REQUIRE(pairs.rows() == patch.size());
        std::size_t wrong = 0;
        for (Index i = 0; i < patch.size(); ++i)
          wrong += row(pairs, i) != brute_force(patch, i, 2.6 * dx + skin, grid.period());
        CHECK(wrong == 0);

        pairs.refresh(patch, sph::KernelType::wendland_c2);
        double worst = 0;
        sph::with_dim(dim, [&](auto d) {
          for (Index i = 0; i < patch.size(); ++i)
            pairs.for_row<d>(i, [&](const sph::Pair<d>& q) {
              const double r = distance(patch, i, q.j, grid.period());
              worst = std::max(worst, std::abs(std::sqrt(q.r2()) - r) / dx);
              worst = std::max(worst, std::abs(q.w / sph::WendlandC2<d>::w(r, 1 / (1.3 * dx)) - 1) *
                                          (r < 2.5 * dx ? 1 : 0));
              // Entries of the skin are out of reach of the kernel.
              if (r > 2.6 * dx) worst = std::max({worst, q.w, -q.f});
            });
        });
        CHECK(worst < 5e-7);  // the geometry of pairs is stored in single precision
      }
}

TEST_CASE("sums over registers of neighbours are those over single neighbours") {
  // Rows of a disordered set have all lengths: most end with fillers.
  const double dx = 1e-4;
  for (int dim : {2, 3}) {
    CAPTURE(dim);
    const double length = (dim == 2 ? 24 : 10) * dx;
    const Particles p = cloud(dim, dx, length, Arrangement::jittered, false);
    const CellGrid grid(dim, Vec3::Zero(), Vec3::Constant(length), 2.6 * dx, {});
    PatchSelector selector(grid, p);
    Patch patch;
    selector.select_all(p, patch);
    sph::PairList pairs;
    pairs.build(patch, grid, 0, std::vector<std::uint8_t>(patch.size(), 1));
    pairs.refresh(patch, sph::KernelType::wendland_c2);
    std::vector<double> field(patch.size());
    Noise noise(5);
    for (double& value : field) value = noise();
    double worst = 0;
    std::size_t fillers = 0, count = 0;
    sph::with_dim(dim, [&](auto d) {
      constexpr int D = d;
      for (Index i = 0; i < patch.size(); ++i) {
        const auto sum = pairs.sum_row<D, 3>(i, [&](const sph::PairLanes<D>& q) {
          return std::array<sph::Lanes, 3>{q.of(field.data()) * q.w, q.f * q.x[D - 1], q.r2() * q.f};
        });
        double plain[3] = {0, 0, 0}, size[3] = {0, 0, 0};
        pairs.for_row<D>(i, [&](const sph::Pair<D>& q) {
          const double terms[3] = {field[q.j] * q.w, q.f * q.x[D - 1], q.r2() * q.f};
          for (int n = 0; n < 3; ++n) {
            plain[n] += terms[n];
            size[n] += std::abs(terms[n]);
          }
        });
        for (int n = 0; n < 3; ++n) worst = std::max(worst, std::abs(sum[n] - plain[n]) / size[n]);
        fillers += pairs.filled_end(i) - pairs.end(i);
        count += pairs.count(i);
      }
    });
    CHECK(worst < 1e-14);
    CHECK(pairs.pairs() == count);
    CHECK(pairs.slots() == count + fillers);
    CHECK((sph::kLaneCount == 1 || fillers > 0));
  }
}

TEST_CASE("a list with a skin still holds every neighbour after particles moved by almost half of it") {
  const double dx = 1e-4, skin = 0.5 * dx, length = 10 * dx;
  Particles p = cloud(3, dx, length, Arrangement::jittered, false);
  const CellGrid grid(3, Vec3::Zero(), Vec3::Constant(length), 2.6 * dx + skin, {});
  PatchSelector selector(grid, p);
  Patch patch;
  selector.select_all(p, patch);
  sph::PairList pairs;
  pairs.build(patch, grid, skin, std::vector<std::uint8_t>(patch.size(), 1));
  Noise noise(3);
  for (Index i = 0; i < patch.size(); ++i) {
    Vec3 move(noise(), noise(), noise());
    move *= 0.499 * skin / move.norm();
    for (int c = 0; c < 3; ++c) patch.x[c][i] += move[c];
  }
  std::size_t missing = 0;
  for (Index i = 0; i < patch.size(); ++i) {
    const auto listed = row(pairs, i);
    for (Index j : brute_force(patch, i, 2.6 * dx, {})) missing += !listed.contains(j);
  }
  CHECK(missing == 0);
}

TEST_CASE("rows are made for liquid, for the solid next to it and for extra particles, and for no other") {
  const double dx = 1e-4, length = 14 * dx;
  Particles p = cloud(3, dx, length, Arrangement::jittered, false);
  const Vec3 centre = Vec3::Constant(0.5 * length);
  for (std::size_t i = 0; i < p.size(); ++i)
    if ((Vec3(p.x[0][i], p.x[1][i], p.x[2][i]) - centre).norm() < 2.5 * dx) p.phase[i] = 1;
  const CellGrid grid(3, Vec3::Zero(), Vec3::Constant(length), 2.6 * dx, {});
  PatchSelector selector(grid, p);
  Patch patch;
  selector.select_all(p, patch);
  std::vector<std::uint8_t> extra(patch.size(), 0);
  extra[5] = extra[1000] = 1;
  sph::PairList pairs;
  pairs.build(patch, grid, 0, extra);
  std::size_t wrong = 0;
  for (Index i = 0; i < patch.size(); ++i) {
    const auto near = brute_force(patch, i, 2.6 * dx, {});
    bool beside = false;
    for (Index j : near) beside = beside || patch.liquid[j];
    const bool wall_of_melt = beside && !patch.liquid[i];
    wrong += pairs.next_to_melt()[i] != wall_of_melt;
    const bool has_row = patch.liquid[i] || wall_of_melt || extra[i];
    wrong += row(pairs, i) != (has_row ? near : std::set<Index>{});
  }
  CHECK(wrong == 0);
}
