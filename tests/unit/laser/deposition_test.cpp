// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "meltray/core/errors.hpp"
#include "meltray/laser/laser.hpp"

using namespace meltray;
using namespace meltray::laser;

namespace {

struct Cloud {
  Components x;
  std::vector<double> weight;
  void add(const Vec3& p, double w) {
    for (std::size_t a = 0; a < 3; ++a) x[a].push_back(p[static_cast<int>(a)]);
    weight.push_back(w);
  }
  PointCloud view() const { return {meltray::view(x), weight.size(), nullptr, 1.0}; }
};

/// Groups and deposits; returns the power that found no particle [W].
double deposit_all(std::vector<Hit> hits, const Cloud& c, double radius, std::vector<double>& power) {
  double lost = 0;
  const auto groups = group_hits(hits, 0.4 * radius, lost);
  return lost + deposit(hits, groups, c.view(), c.weight.data(), radius, power.data());
}

}  // namespace

TEST_CASE("a deposit is shared by distance and weight") {
  Cloud c;
  c.add({0, 0, 0}, 1);
  c.add({1, 0, 0}, 0.5);
  c.add({0, 1, 0}, 0);    // not on the surface
  c.add({0, 0, 2.5}, 1);  // too far
  std::vector<double> power = {1, 1, 1, 1};
  const Hit hit{{0.25, 0, 0}, 10};
  CHECK(deposit_all({hit}, c, 2.0, power) == 0);
  const double a = std::pow(1 - 0.125, 2), b = 0.5 * std::pow(1 - 0.375, 2);
  CHECK(power[0] == Approx(1 + 10 * a / (a + b)));
  CHECK(power[1] == Approx(1 + 10 * b / (a + b)));
  CHECK(power[2] == 1);
  CHECK(power[3] == 1);
}

TEST_CASE("a hit without a neighbour goes to the nearest surface particle") {
  Cloud c;
  for (int i = 0; i < 30; ++i) c.add({0.3 * i, 0.1 * (i % 4), -0.05 * i}, i % 3 == 0 ? 1.0 : 0.0);
  for (const Vec3& x : {Vec3(4, 3, 2), Vec3(-200, 0, 0), Vec3(9, 0, 100), Vec3(4.4, 0.4, 0.4)}) {
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < 30; i += 3) {
      const auto distance = [&](std::size_t j) { return (Vec3(c.x[0][j], c.x[1][j], c.x[2][j]) - x).norm(); };
      if (distance(i) < distance(nearest)) nearest = i;
    }
    std::vector<double> power(30, 0.0);
    const Hit hit{x, 2};
    CHECK(deposit_all({hit}, c, 0.2, power) == 0);
    CHECK(power[nearest] == 2);
  }
}

TEST_CASE("without surface particles nothing is deposited") {
  Cloud c;
  c.add({0, 0, 0}, 0);
  std::vector<double> power(1, 0.0);
  const std::vector<Hit> hits = {{{0, 0, 0}, 2}, {{1, 0, 0}, 3}};
  CHECK(deposit_all(hits, c, 1, power) == 5);
  CHECK(power[0] == 0);
  CHECK_THROWS_AS(deposit_all(hits, c, 0, power), NumericalFailure);
}

TEST_CASE("deposits conserve power") {
  Cloud c;
  for (int i = 0; i < 3000; ++i)
    c.add({std::fmod(i * 0.754877666, 1.0), std::fmod(i * 0.569840290, 1.0), 0.02 * std::sin(i)},
          i % 2 ? 1.0 : 0.3);
  std::vector<Hit> hits;
  double in = 0;
  for (int i = 0; i < 2000; ++i) {
    hits.push_back({{std::fmod(i * 0.618033989, 1.0), (i + 0.5) / 2000, 0}, 1 + std::cos(i)});
    in += hits.back().power;
  }
  std::vector<double> power(3000, 0.0);
  const double left = deposit_all(hits, c, 0.05, power);
  double out = left;
  for (const double p : power) out += p;
  CHECK(left == 0);
  CHECK(out == Approx(in).epsilon(1e-12));
}

TEST_CASE("hits are grouped by cube, in their former order within it") {
  std::vector<Hit> hits = {{{0.9, 0, 0}, 1}, {{2.5, 0, 0}, 2}, {{0.1, 0.2, 0.3}, 3}, {{-0.1, 0, 0}, 4}};
  hits.push_back({{std::numeric_limits<double>::quiet_NaN(), 0, 0}, 5});
  double lost = 0;
  const auto groups = group_hits(hits, 1, lost);
  CHECK(lost == 5);
  REQUIRE(hits.size() == 4);
  REQUIRE(groups.size() == 3);
  for (const HitGroup& g : groups)
    for (std::size_t h = g.first; h < g.last; ++h)
      CHECK((hits[h].position - g.centre).cwiseAbs().maxCoeff() <= 0.5);
  CHECK(groups[1].last - groups[1].first == 2);
  CHECK(hits[groups[1].first].power == 1);
  CHECK(hits[groups[1].first + 1].power == 3);
}
