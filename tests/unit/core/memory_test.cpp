// SPDX-License-Identifier: MIT
#include "meltray/core/memory.hpp"

#include <catch2/catch.hpp>
#include <vector>

using namespace meltray;

TEST_CASE("memory: an array that grows a little holds little more than it needs") {
  std::vector<double> v;
  resize_anew(v, 1000);
  CHECK(v.size() == 1000);
  resize_anew(v, 1100);  // beyond what is held: resize() would go to 2000
  CHECK(v.size() == 1100);
  CHECK(v.capacity() <= 1100 + 1100 / 16);
  const double* const place = v.data();
  resize_anew(v, 1101);
  CHECK(v.data() == place);
}

TEST_CASE("memory: arrays that are given back hold nothing") {
  std::vector<double> v(100);
  std::array<std::vector<char>, 2> c{std::vector<char>(10), std::vector<char>(20)};
  free_memory(v, c);
  CHECK(held_bytes(v) + held_bytes(c) == 0);
}

TEST_CASE("memory: what arrays hold counts, not what they use") {
  std::vector<double> v;
  v.reserve(100);
  std::vector<char> c;
  c.reserve(10);
  CHECK(held_bytes(v, c) == v.capacity() * sizeof(double) + c.capacity());
  CHECK(held_bytes(std::array<std::vector<double>, 2>{}) == 0);
}
