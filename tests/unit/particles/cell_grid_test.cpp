// SPDX-License-Identifier: MIT
#include "meltray/particles/cell_grid.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <set>
#include <vector>

#include "meltray/core/errors.hpp"

using namespace meltray;

namespace {

Index cell_at(const CellGrid& grid, const Vec3& x) {
  return grid.cell(ConstField{&x[0], &x[1], &x[2]}, 0);
}

std::vector<Index> block(const CellGrid& grid, Index centre, Index reach) {
  std::vector<Index> cells;
  grid.for_block(centre, reach, [&](Index c) { cells.push_back(c); });
  return cells;
}

}  // namespace

TEST_CASE("cells are at least as wide as asked and a box of whole widths is not cut short") {
  const CellGrid grid(3, Vec3::Zero(), Vec3(1.0, 0.7, 0.35), 0.1, {});
  CHECK(grid.cells() == 10 * 7 * 3);
  const auto k = grid.unflatten(grid.flat({4, 5, 2}));
  CHECK((k[0] == 4 && k[1] == 5 && k[2] == 2));
  CHECK(CellGrid(2, Vec3::Zero(), Vec3(1, 0.05, 0), 0.1, {}).cells() == 10);
}

TEST_CASE("positions outside a non-periodic box, and NaN, fall into outer cells") {
  const CellGrid grid(3, Vec3::Zero(), Vec3::Constant(1), 0.1, {});
  CHECK(cell_at(grid, Vec3(-5, 0.05, 0.05)) == cell_at(grid, Vec3(0.05, 0.05, 0.05)));
  CHECK(cell_at(grid, Vec3(7, 2, 1e300)) == grid.cells() - 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(cell_at(grid, Vec3(nan, nan, nan)) == 0);
}

TEST_CASE("blocks stop at free faces and wrap around at periodic ones, each cell once") {
  const CellGrid free(3, Vec3::Zero(), Vec3::Constant(1), 0.1, {});
  CHECK(block(free, free.flat({0, 5, 9}), 1).size() == 2 * 3 * 2);
  const CellGrid wrapped(3, Vec3::Zero(), Vec3::Constant(1), 0.1, {true, true, true});
  CHECK(wrapped.period()[1] == Approx(1));
  const auto cells = block(wrapped, wrapped.flat({0, 5, 9}), 1);
  const std::set<Index> unique(cells.begin(), cells.end());
  CHECK((cells.size() == 27 && unique.size() == 27));
  CHECK(unique.contains(wrapped.flat({9, 4, 0})));
  // Reach 2 in a direction of four cells would count one cell twice.
  const CellGrid narrow(2, Vec3::Zero(), Vec3(0.4, 1, 0), 0.1, {true, false, false});
  const auto wide = block(narrow, narrow.flat({1, 5, 0}), 2);
  CHECK((wide.size() == 4 * 5 && std::set<Index>(wide.begin(), wide.end()).size() == wide.size()));
}

TEST_CASE("cells near a box are those of the block that some point of the box is close to") {
  const CellGrid grid(3, Vec3::Zero(), Vec3(1, 1, 0.8), 0.1, {false, true, false});
  const Vec3 low(0.52, 0.51, 0.73), high(0.55, 0.57, 0.74);  // in the topmost cells, which go on upwards
  const Index centre = cell_at(grid, low);
  const double far = 0.17;
  std::vector<Index> near;
  grid.for_near(centre, 2, far, low, high, [&](Index c) { near.push_back(c); });
  std::vector<Index> expected;
  for (const Index c : block(grid, centre, 2)) {
    const auto k = grid.unflatten(c);
    const double dx = std::max({0.0, 0.1 * k[0] - high[0], low[0] - 0.1 * (k[0] + 1)});
    const double dz = std::max(0.0, k[2] < 7 ? low[2] - 0.1 * (k[2] + 1) : 0.0);
    if (dx * dx + dz * dz <= far * far) expected.push_back(c);
  }
  CHECK(near == expected);
  CHECK((near.size() < block(grid, centre, 2).size() && near.size() > 5 * 3));
  // However far it reaches: elastic solid asks for as many cells as the case says.
  const CellGrid wide(2, Vec3::Zero(), Vec3(6, 6, 0), 0.1, {});
  const Index middle = wide.flat({30, 30, 0});
  std::vector<Index> all;
  wide.for_near(middle, 20, 100, Vec3(3.01, 3.01, 0), Vec3(3.02, 3.02, 0),
                [&](Index c) { all.push_back(c); });
  CHECK(all == block(wide, middle, 20));
}

TEST_CASE("positions outside a periodic box are those of their image inside") {
  const CellGrid grid(2, Vec3(-0.2, 0, 0), Vec3(0.8, 1, 0), 0.1, {true, false, false});
  CHECK(cell_at(grid, Vec3(-0.25, 0.5, 0)) == cell_at(grid, Vec3(0.75, 0.5, 0)));
  CHECK(cell_at(grid, Vec3(1.83, 0.5, 0)) == cell_at(grid, Vec3(-0.17, 0.5, 0)));
}

TEST_CASE("a periodic box shorter than three cells is refused") {
  CHECK_NOTHROW(CellGrid(2, Vec3::Zero(), Vec3(0.3, 1, 0), 0.1, {true, false, false}));
  CHECK_THROWS_AS(CellGrid(2, Vec3::Zero(), Vec3(0.29, 1, 0), 0.1, {true, false, false}), UsageError);
}
