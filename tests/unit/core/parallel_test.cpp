// SPDX-License-Identifier: MIT
#include "meltray/core/parallel.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <random>
#include <vector>

using namespace meltray;

namespace {

/// Sets the number of threads for one scope.
struct WithThreads {
  explicit WithThreads(int n) : before(threads()) { set_threads(n); }
  ~WithThreads() { set_threads(before); }
  int before;
};

bool same_bits(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Numbers over 16 decades and both signs, so that another order of summation gives another sum.
std::vector<double> wild_numbers(std::size_t n) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-8, 8), sign(-1, 1);
  std::vector<double> v(n);
  for (double& x : v) x = std::copysign(std::pow(10.0, exponent(random)), sign(random));
  return v;
}

/// Sizes around the limits at which loops and reductions change their form.
constexpr std::ptrdiff_t kSizes[] = {0, 1, 511, 512, 1023, 1024, 1025, 2048, 2049, 100003};

}  // namespace

TEST_CASE("parallel_sum has the same bits with 1, 2 and 3 threads") {
  for (const std::ptrdiff_t n : kSizes) {
    CAPTURE(n);
    const auto v = wild_numbers(static_cast<std::size_t>(n));
    const auto sum = [&](int thread_count) {
      WithThreads scope(thread_count);
      return parallel_sum(n, [&](std::ptrdiff_t i) { return v[i]; });
    };
    const double one = sum(1);
    CHECK(same_bits(one, sum(2)));
    CHECK(same_bits(one, sum(3)));
    // Any order of summation is within n eps of the sum of magnitudes.
    long double exact = 0, magnitude = 0;
    for (const double x : v) exact += x, magnitude += std::abs(x);
    CHECK(std::abs(one - static_cast<double>(exact)) <= static_cast<double>(n * magnitude * 2.3e-16L));
  }
}

TEST_CASE("the order of summation matters for the numbers of these tests") {
  // Otherwise the test above would show nothing: the plain loop rounds differently.
  const std::ptrdiff_t n = 100003;
  const auto v = wild_numbers(n);
  double forward = 0, backward = 0;
  for (std::ptrdiff_t i = 0; i < n; ++i) forward += v[i], backward += v[n - 1 - i];
  CHECK_FALSE(same_bits(forward, backward));
}

TEST_CASE("parallel_sum of integers is exact") {
  const std::ptrdiff_t n = 54321;
  WithThreads scope(2);
  CHECK(parallel_sum(n, [](std::ptrdiff_t i) { return static_cast<double>(i); }) == 0.5 * n * (n - 1));
}

TEST_CASE("parallel_max has the same bits with 1 and 2 threads and respects its floor") {
  for (const std::ptrdiff_t n : kSizes) {
    CAPTURE(n);
    const auto v = wild_numbers(static_cast<std::size_t>(n));
    const auto largest = [&](int thread_count, double floor) {
      WithThreads scope(thread_count);
      return parallel_max(n, floor, [&](std::ptrdiff_t i) { return v[i]; });
    };
    double expected = -1e300;
    for (const double x : v) expected = std::max(expected, x);
    CHECK(same_bits(largest(1, -1e300), expected));
    CHECK(same_bits(largest(2, -1e300), expected));
    CHECK(largest(2, 1e9) == 1e9);
  }
}

TEST_CASE("parallel_for visits every index once") {
  for (const std::ptrdiff_t n : kSizes) {
    CAPTURE(n);
    std::vector<int> visits(static_cast<std::size_t>(n), 0);
    WithThreads scope(2);
    parallel_for(n, [&](std::ptrdiff_t i) { ++visits[i]; });
    CHECK(std::accumulate(visits.begin(), visits.end(), std::int64_t{0}) == n);
    CHECK(std::all_of(visits.begin(), visits.end(), [](int count) { return count == 1; }));
  }
}

TEST_CASE("parallel_reduce works for other types than numbers") {
  struct Range {
    double low, high;
  };
  const auto v = wild_numbers(5000);
  const auto range = [&](int thread_count) {
    WithThreads scope(thread_count);
    return parallel_reduce(
        5000, Range{1e300, -1e300},
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          Range r{1e300, -1e300};
          for (std::ptrdiff_t i = begin; i < end; ++i) r = {std::min(r.low, v[i]), std::max(r.high, v[i])};
          return r;
        },
        [](Range a, Range b) {
          return Range{std::min(a.low, b.low), std::max(a.high, b.high)};
        });
  };
  const Range one = range(1), two = range(2);
  CHECK(one.low == *std::min_element(v.begin(), v.end()));
  CHECK(one.high == *std::max_element(v.begin(), v.end()));
  CHECK(same_bits(one.low, two.low));
  CHECK(same_bits(one.high, two.high));
}
