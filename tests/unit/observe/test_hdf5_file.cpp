// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "meltray/core/errors.hpp"
#include "meltray/observe/hdf5_file.hpp"

using namespace meltray;
using namespace meltray::observe;

TEST_CASE("HDF5 image returns every value bit for bit") {
  std::vector<double> numbers = {
      0.0, -0.0, 1.0 / 3, 5e-324, 1.7976931348623157e308, std::numeric_limits<double>::infinity()};
  const std::vector<std::uint8_t> flags = {0, 255, 7};
  const std::vector<std::int32_t> ids = {-5, 2147483647, 0};
  Hdf5Writer out;
  out.dataset("group/numbers", numbers);
  out.dataset("flags", flags);
  out.dataset("ids", ids);
  out.dataset("empty", std::vector<double>{});
  out.scalar("a/b/c", 0.1);
  out.scalar("count", std::int64_t{9007199254740993});
  out.scalar("name", std::string_view("Schweiß"));
  out.scalar("nothing", std::string_view(""));
  out.attribute("/", "time_s", 0.125);

  const Hdf5Reader in(out.image(), "image");
  std::vector<double> n;
  in.dataset("group/numbers", n);
  REQUIRE(n.size() == numbers.size());
  for (std::size_t i = 0; i < n.size(); ++i) {
    CHECK(n[i] == numbers[i]);
    CHECK(std::signbit(n[i]) == std::signbit(numbers[i]));
  }
  std::vector<std::uint8_t> f;
  in.dataset("flags", f);
  CHECK(f == flags);
  std::vector<std::int32_t> i;
  in.dataset("ids", i);
  CHECK(i == ids);
  in.dataset("empty", n);
  CHECK(n.empty());
  double d = 0;
  in.scalar("a/b/c", d);
  CHECK(d == 0.1);
  std::int64_t k = 0;
  in.scalar("count", k);
  CHECK(k == 9007199254740993);
  std::string s;
  in.scalar("name", s);
  CHECK(s == "Schweiß");
  in.scalar("nothing", s);
  CHECK(s.empty());
  CHECK(in.attribute_double("/", "time_s") == 0.125);
}

TEST_CASE("compressed single-precision rows come back") {
  std::vector<float> rows(3 * 20000);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = std::sin(static_cast<float>(i));
  Hdf5Writer out;
  out.dataset("position", rows, 3, Hdf5Writer::Packing::compressed);
  out.dataset("none", std::vector<float>{}, 3, Hdf5Writer::Packing::compressed);
  const auto image = out.image();
  const Hdf5Reader in(image, "image");
  std::vector<float> back;
  in.dataset("position", back);
  CHECK(back == rows);
  CHECK(in.entries("none") == 0);
}

TEST_CASE("what an HDF5 file does not hold is named") {
  Hdf5Writer out;
  out.scalar("time_s", 1.0);
  const Hdf5Reader in(out.image(), "some/file.h5");
  std::int64_t k = 0;
  double d = 0;
  CHECK_THROWS_WITH(in.scalar("step", k), "some/file.h5: holds no 'step'");
  CHECK_THROWS_WITH(in.scalar("time_s", k), Catch::Contains("another type"));
  CHECK_NOTHROW(in.scalar("time_s", d));
  const std::vector<std::byte> text(100, std::byte{'x'});
  CHECK_THROWS_AS(Hdf5Reader(text, "x"), UsageError);
}
