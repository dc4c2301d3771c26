// SPDX-License-Identifier: MIT
#include "meltray/particles/patch.hpp"

#include <catch2/catch.hpp>
#include <numeric>
#include <set>

using namespace meltray;

namespace {

constexpr double kWidth = 0.25;

/// A lattice of 20^3 solid particles in a unit box, with wall dummies below.
struct Block {
  Particles p;
  CellGrid grid{3, Vec3(0, 0, -0.15), Vec3(1, 1, 1), kWidth, {}};
  Block() {
    for (int k = -3; k < 20; ++k)
      for (int j = 0; j < 20; ++j)
        for (int i = 0; i < 20; ++i)
          p.add(0.05 * Vec3(i + 0.5, j + 0.5, k + 0.5), 100.0 + i, 1, 0.06, k < 0 ? 5 : 0);
  }
  Vec3 at(Index i) const { return {p.x[0][i], p.x[1][i], p.x[2][i]}; }
  void melt(const Vec3& centre, double radius) {
    for (std::size_t i = 0; i < p.size(); ++i)
      if (!p.is_wall(i) && (at(static_cast<Index>(i)) - centre).norm() < radius) p.phase[i] = 1;
  }
};

std::set<Index> members(const Patch& p) {
  std::set<Index> s(p.global.begin(), p.global.end());
  REQUIRE(static_cast<Index>(s.size()) == p.size());
  return s;
}

}  // namespace

TEST_CASE("selecting everything takes every particle once, sorted by cell") {
  Block b;
  b.melt(Vec3(0.5, 0.5, 1), 0.3);
  b.p.flags[77] |= kRemoved;
  PatchSelector selector(b.grid, b.p);
  Patch patch;
  selector.select_all(b.p, patch);
  CHECK(members(patch).size() == b.p.size() - 1);
  CHECK_FALSE(members(patch).contains(77));
  REQUIRE(patch.cell_start.size() == static_cast<std::size_t>(b.grid.cells()) + 1);
  std::size_t wrong = 0;
  for (Index c = 0; c < b.grid.cells(); ++c)
    for (Index i = patch.cell_start[c]; i < patch.cell_start[c + 1]; ++i) {
      const Index g = patch.global[i];
      wrong += b.grid.cell(view(std::as_const(patch.x)), i) != c || patch.h[i] != b.p.h[g] ||
               patch.wall[i] != b.p.wall[g] || patch.liquid[i] != b.p.phase[g] ||
               patch.x[2][i] != b.p.x[2][g];
    }
  CHECK(wrong == 0);
}

TEST_CASE(
    "near the melt: every particle within two cell widths of liquid or one of `also` is there, far ones "
    "not") {
  Block b;
  b.melt(Vec3(0.1, 0.1, 1), 0.12);
  PatchSelector selector(b.grid, b.p);
  Patch patch;
  const std::vector<Index> also{static_cast<Index>(b.p.size()) - 1};
  selector.select_near_melt(b.p, also, patch);
  const auto in = members(patch);
  std::size_t missing = 0, far = 0;
  const double cell = 1.0 / 4;  // the box is four cells of at least kWidth wide in x and y
  for (Index i = 0; i < static_cast<Index>(b.p.size()); ++i) {
    const double other = (b.at(i) - b.at(also[0])).norm();
    double least = other;
    for (Index m : selector.moving()) least = std::min(least, (b.at(i) - b.at(m)).norm());
    missing +=
        (least < 2 * kWidth && least < other && !in.contains(i)) || (other < kWidth && !in.contains(i));
    far += least > (2 + std::sqrt(3.0)) * 1.16 * cell && in.contains(i);
  }
  CHECK(missing == 0);
  CHECK(far == 0);
  CHECK(in.size() < b.p.size());
}

TEST_CASE("melting and solidifying keep the selection that a fresh selector would make") {
  Block b;
  b.melt(Vec3(0.5, 0.5, 1), 0.2);
  PatchSelector selector(b.grid, b.p);
  const auto change = [&](Index i, bool liquid) {
    if (liquid)
      selector.melted(b.p, i);
    else
      selector.solidified(b.p, i);
    b.p.phase[i] = liquid;
  };
  const Index first = selector.moving().front(), last = selector.moving().back();
  change(first, false);
  change(last, false);
  change(first, true);
  change(3 * 400 + 7, true);  // a particle of the lowest layer of material
  b.p.x[0][first] += 0.4;     // liquid may move to other cells
  Patch kept, fresh;
  selector.select_near_melt(b.p, {}, kept);
  PatchSelector again(b.grid, b.p);
  again.select_near_melt(b.p, {}, fresh);
  CHECK(selector.moving() == again.moving());
  CHECK(kept.global == fresh.global);
  CHECK(kept.cell_start == fresh.cell_start);
  CHECK(kept.cells == fresh.cells);
  // The cells named are all that hold anything, also after selections of other places.
  selector.select_around(b.p, std::vector<Index>{0}, fresh);
  selector.select_near_melt(b.p, {}, fresh);
  CHECK(kept.global == fresh.global);
  CHECK(kept.cells == fresh.cells);
  CHECK(std::is_sorted(kept.cells.begin(), kept.cells.end()));
  Index held = 0;
  for (const Index c : kept.cells) held += kept.cell_start[c + 1] - kept.cell_start[c];
  CHECK(held == kept.size());
}

TEST_CASE("particles around centres are complete within a cell width") {
  Block b;
  b.melt(Vec3(0.5, 0.5, 0.9), 0.3);
  PatchSelector selector(b.grid, b.p);
  const std::vector<Index> centres{3 * 400 + 21, 3 * 400 + 390};
  Patch patch;
  selector.select_around(b.p, centres, patch);
  const auto in = members(patch);
  std::size_t missing = 0;
  for (Index i = 0; i < static_cast<Index>(b.p.size()); ++i)
    for (Index c : centres) missing += (b.at(i) - b.at(c)).cwiseAbs().maxCoeff() < kWidth && !in.contains(i);
  CHECK(missing == 0);
  CHECK(in.size() < b.p.size());
}

TEST_CASE("gather and for_resting_near find what a search by hand finds") {
  Block b;
  b.melt(Vec3(0.5, 0.5, 1), 0.3);
  PatchSelector selector(b.grid, b.p);
  const Vec3 min(0.31, 0.2, -0.1), max(0.72, 0.55, 0.93);
  std::vector<Index> found, expected;
  selector.gather(b.p, min, max, found);
  for (Index i = 0; i < static_cast<Index>(b.p.size()); ++i)
    if ((b.at(i).array() >= min.array()).all() && (b.at(i).array() <= max.array()).all())
      expected.push_back(i);
  std::sort(found.begin(), found.end());
  CHECK(found == expected);

  const Vec3 point(0.52, 0.48, 0.7);
  std::vector<Index> near, by_hand;
  selector.for_resting_near(b.p, point, 0.2, [&](Index i) { near.push_back(i); });
  for (Index i = 0; i < static_cast<Index>(b.p.size()); ++i)
    if (!b.p.is_liquid(i) && !b.p.is_wall(i) && (b.at(i) - point).norm() < 0.2) by_hand.push_back(i);
  std::sort(near.begin(), near.end());
  CHECK(near == by_hand);
}

TEST_CASE("write_back moves liquid only, enthalpy and pressure of all") {
  Block b;
  b.melt(Vec3(0.5, 0.5, 1), 0.2);
  PatchSelector selector(b.grid, b.p);
  Patch patch;
  selector.select_all(b.p, patch);
  const Particles before = b.p;
  for (Index i = 0; i < patch.size(); ++i) {
    patch.x[0][i] += 1;
    patch.v[1][i] = 2;
    patch.h[i] += 3;
    patch.pressure[i] = 4;
  }
  write_back(patch, b.p);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < b.p.size(); ++i) {
    const bool liquid = b.p.is_liquid(i);
    wrong += b.p.x[0][i] != before.x[0][i] + (liquid ? 1 : 0) || b.p.v[1][i] != (liquid ? 2 : 0) ||
             b.p.h[i] != before.h[i] + 3 || b.p.pressure[i] != 4;
  }
  CHECK(wrong == 0);
}

TEST_CASE("solid near the melt is elastic, and what leaves that zone comes to rest") {
  Block b;
  b.melt(Vec3(0.5, 0.5, 1), 0.1);
  PatchSelector selector(b.grid, b.p);
  Patch patch;
  constexpr double kDepth = 0.31;  // more than a cell, and no distance of the lattice
  selector.select_near_melt(b.p, {}, patch, 1 + selector.cells_across(kDepth));
  selector.mark_elastic(b.p, patch, kDepth);
  std::vector<Index> melt;
  for (Index i = 0; i < static_cast<Index>(b.p.size()); ++i)
    if (b.p.is_liquid(i)) melt.push_back(i);
  std::size_t wrong = 0;
  for (Index i = 0; i < static_cast<Index>(b.p.size()); ++i) {
    bool near = false;
    for (const Index j : melt) near = near || (b.at(i) - b.at(j)).norm() < kDepth;
    wrong += b.p.has(i, kMobile) != (near && !b.p.is_liquid(i) && !b.p.is_wall(i));
  }
  for (Index k = 0; k < patch.size(); ++k)
    wrong +=
        (patch.elastic[k] == static_cast<std::uint8_t>(Elastic::free)) != b.p.has(patch.global[k], kMobile);
  CHECK(wrong == 0);

  std::vector<bool> was;
  for (std::size_t i = 0; i < b.p.size(); ++i) {
    was.push_back(b.p.has(i, kMobile));
    if (was[i]) b.p.v[0][i] = 1;
    b.p.phase[i] = 0;  // the melt freezes; a new pool far from the old one
  }
  b.melt(Vec3(0.125, 0.125, 1), 0.05);
  selector = PatchSelector(b.grid, b.p);
  selector.select_near_melt(b.p, {}, patch, 1 + selector.cells_across(kDepth));
  selector.mark_elastic(b.p, patch, kDepth);
  std::size_t resting = 0, moving = 0;
  for (std::size_t i = 0; i < b.p.size(); ++i) {
    if (!was[i]) continue;
    (b.p.has(i, kMobile) ? moving : resting) += 1;
    CHECK(b.p.v[0][i] == (b.p.has(i, kMobile) ? 1 : 0));
  }
  CHECK(resting > 0);
  CHECK(moving > 0);
}

TEST_CASE("elastic solid changes cells as it moves, and is found there") {
  Block b;
  for (auto& component : b.p.stress) component.assign(b.p.size(), 0.0);
  PatchSelector selector(b.grid, b.p);
  Patch patch;
  selector.select_all(b.p, patch);
  selector.mark_elastic(b.p, patch, 1);
  Index moved = -1;
  for (Index k = 0; k < patch.size(); ++k)
    if (patch.elastic[k] && patch.x[0][k] > 0.2 && patch.x[0][k] < 0.25) {
      patch.x[0][k] += 0.05;
      moved = patch.global[k];
    }
  REQUIRE(moved >= 0);
  selector.follow(b.p, patch);
  write_back(patch, b.p);
  CHECK(b.p.x[0][moved] > 0.25);
  selector.melted(b.p, moved);  // looks for it in the cell where it is now
  CHECK(selector.moving() == std::vector<Index>{moved});
  PatchSelector fresh(b.grid, b.p);
  Patch expected;
  selector.solidified(b.p, moved);
  selector.select_all(b.p, patch);
  fresh.select_all(b.p, expected);
  CHECK(patch.global == expected.global);
}
