// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "app/measurements.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/observe/files.hpp"
#include "unit/observe/temporary_folder.hpp"

using namespace meltray;
using namespace meltray::app;
using Catch::Contains;

namespace {

std::vector<Measurement> read(const std::string& text) {
  TemporaryFolder t;
  observe::replace_file(t / "m.csv", text);
  return read_measurements(t / "m.csv");
}

const std::string kHeader =
    "material,f_hz,amplitude_ratio_mm_per_kw,mean_depth_mm,phase_lag_deg,definition,uncertainty,source\n";

}  // namespace

TEST_CASE("measurements are read, empty fields stay empty") {
  const auto m = read("# comment\n" + kHeader +
                      "iron,100,0.8,,45,first harmonic,0.1,\"Doe, 2020\"\n\niron,250,,2.0,,,,\r\n");
  REQUIRE(m.size() == 2);
  CHECK(m[0].material == "iron");
  CHECK(m[0].frequency == 100);
  CHECK(*m[0].ratio_mm_per_kw == 0.8);
  CHECK_FALSE(m[0].mean_depth_mm.has_value());
  CHECK(*m[0].phase_lag_deg == 45);
  CHECK(m[0].source == "Doe, 2020");
  CHECK(*m[1].mean_depth_mm == 2);
  CHECK_FALSE(m[1].ratio_mm_per_kw.has_value());
}

TEST_CASE("columns may stand in any order and optional ones may be missing") {
  const auto m = read("f_hz,material\n500,aluminium\n");
  REQUIRE(m.size() == 1);
  CHECK(m[0].frequency == 500);
}

TEST_CASE("a bad CSV is named with file and line") {
  CHECK_THROWS_WITH(read("material,f_hz,depth\niron,1,2\n"), Contains("m.csv:1") && Contains("'depth'"));
  CHECK_THROWS_WITH(read("material,mean_depth_mm\niron,1\n"), Contains("'f_hz' is missing"));
  CHECK_THROWS_WITH(read("material,material,f_hz\niron,1,2\n"), Contains("twice"));
  CHECK_THROWS_WITH(read(kHeader + "iron,100\n"),
                    Contains("m.csv:2") && Contains("2 fields") && Contains("8"));
  CHECK_THROWS_WITH(read(kHeader + "iron,ten,,,,,,\n"), Contains("m.csv:2: f_hz: found 'ten'"));
  CHECK_THROWS_WITH(read(kHeader + "iron,0,,,,,,\n"), Contains("above 0"));
  CHECK_THROWS_WITH(read(kHeader + ",100,,,,,,\n"), Contains("material"));
  CHECK_THROWS_WITH(read(kHeader + "iron,100,-1,,,,,\n"), Contains("0 or more"));
  CHECK_THROWS_WITH(read(kHeader + "iron,100,\"1,,,,,\n"), Contains("quotation mark"));
  CHECK_THROWS_WITH(read(kHeader), Contains("no rows"));
  CHECK_THROWS_WITH(read(""), Contains("no header"));
  CHECK_THROWS_AS(read_measurements("no-such-file.csv"), UsageError);
}
