// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "meltray/core/errors.hpp"
#include "meltray/observe/files.hpp"
#include "meltray/observe/history.hpp"
#include "unit/observe/temporary_folder.hpp"

using namespace meltray;
using namespace meltray::observe;

namespace {

std::string line_at(double t) {
  HistoryRow row;
  row.time = t;
  row.capillary_depth = t / 3;
  row.limiter = "viscous";
  return history_line(row);
}

}  // namespace

TEST_CASE("numbers of history.csv read back to the same bits") {
  TemporaryFolder folder;
  const double values[] = {0.1, 1.0 / 3, 2e-5 / 7, 4.9e-324};
  {
    LineFile out(folder / "history.csv");
    out.append(history_header());
    for (const double v : values) out.append(line_at(v));
  }
  const auto table = read_history(folder / "history.csv");
  REQUIRE(table.at("time_s").size() == 4);
  for (int i = 0; i < 4; ++i) {
    CHECK(table.at("time_s")[i] == values[i]);
    CHECK(table.at("capillary_depth_m")[i] == values[i] / 3);
  }
}

TEST_CASE("history.csv is cut after the checkpoint") {
  TemporaryFolder folder;
  const auto file = folder / "history.csv";
  const std::string head = history_header() + "\n";
  const std::string kept = head + line_at(0) + "\n" + line_at(1e-5) + "\n";
  SECTION("later rows go, the row at the time itself stays") {
    replace_file(file, kept + line_at(2e-5) + "\n" + line_at(3e-5) + "\n");
    cut_history(file, 1e-5);
    CHECK(read_text(file) == kept);
  }
  SECTION("an incomplete last line goes") {
    replace_file(file, kept + "1.5e-0");
    cut_history(file, 1);
    CHECK(read_text(file) == kept);
  }
  SECTION("nothing to cut") {
    replace_file(file, std::string_view(kept));
    cut_history(file, 1e-5);
    CHECK(read_text(file) == kept);
  }
  SECTION("lines at the end that are no rows go") {
    replace_file(file, kept + "!!!\n" + line_at(2e-5) + "\n");
    cut_history(file, 1e-5);
    CHECK(read_text(file) == kept);
  }
  SECTION("a damaged line before rows that stay is refused, and nothing is lost") {
    const std::string text = head + line_at(0) + "\n!!!\n" + line_at(1e-5) + "\n";
    replace_file(file, std::string_view(text));
    CHECK_THROWS_WITH(cut_history(file, 1e-5), Catch::Contains("history.csv:3: no row of numbers"));
    CHECK(read_text(file) == text);
  }
  SECTION("foreign columns are refused") {
    replace_file(file, std::string_view("a,b\n1,2\n"));
    CHECK_THROWS_AS(cut_history(file, 1), UsageError);
  }
}

TEST_CASE("a broken history.csv is named with its line") {
  TemporaryFolder folder;
  const auto file = folder / "history.csv";
  replace_file(file, std::string_view("time_s,x\n0,1\n1,abc\n"));
  CHECK_THROWS_WITH(read_history(file), Catch::Contains("history.csv:3") && Catch::Contains("abc"));
}

TEST_CASE("the main limiter is the most frequent one") {
  StepsSinceRow since;
  CHECK(since.main_limiter() == "start");
  for (const char* name : {"viscous", "output", "viscous"}) since.add({0, 2e-6, name});
  CHECK(since.main_limiter() == "viscous");
  CHECK(since.mean_step() == Approx(2e-6));
}
