// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "app/validate/known_failures.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/observe/files.hpp"
#include "unit/observe/temporary_folder.hpp"

using namespace meltray;
using namespace meltray::app;
using Catch::Contains;

namespace {

Row row(const char* id, const char* quantity, double error) {
  Row r = limit_row(quantity, error, 1, {});
  r.id = id;
  return r;
}

}  // namespace

TEST_CASE("a known failure is marked by id and quantity, with a star for anything, and still fails") {
  TemporaryFolder t;
  observe::replace_file(
      t / "known.toml",
      "[[failure]]\nid = \"drop\"\nquantity = \"speed\"\nreason = \"noise\"\nworst = 2.5\n"
      "[[failure]]\nid = \"wedge\"\nquantity = \"15 deg: *, fine\"\nreason = \"tip\"\nworst = 3\n");
  Rows rows = {row("drop", "speed", 2),
               row("drop", "speed", 0.5),
               row("drop", "pressure", 2),
               row("wedge", "15 deg: iron, fine", 2),
               row("wedge", "45 deg: iron, fine", 2),
               row("plate", "speed", 2)};
  KnownFailures(t / "known.toml").mark(rows);
  CHECK(rows[0].known_failure == "noise");
  CHECK_FALSE(rows[0].passed());
  CHECK(rows[1].known_failure.empty());  // it passes
  CHECK(rows[2].known_failure.empty());
  CHECK(rows[3].known_failure == "tip");
  CHECK(rows[4].known_failure.empty());
  CHECK(rows[5].known_failure.empty());
}

TEST_CASE("a failure that is worse than the list says, or no number, is a new one") {
  TemporaryFolder t;
  observe::replace_file(
      t / "known.toml",
      "[[failure]]\nid = \"drop\"\nquantity = \"speed\"\nreason = \"noise\"\nworst = 2.5\n");
  Rows rows = {row("drop", "speed", 2.6), row("drop", "speed", std::nan(""))};
  KnownFailures(t / "known.toml").mark(rows);
  CHECK(rows[0].known_failure.empty());
  CHECK(rows[1].known_failure.empty());
}

TEST_CASE("a list of known failures without a reason or a largest error is refused with its line") {
  TemporaryFolder t;
  const std::string entry = "\n[[failure]]\nid = \"drop\"\nquantity = \"speed\"\n";
  observe::replace_file(t / "known.toml", entry);
  CHECK_THROWS_WITH(KnownFailures(t / "known.toml"), Contains("known.toml:2: reason: found nothing"));
  observe::replace_file(t / "known.toml", entry + "reason = \"noise\"\n");
  CHECK_THROWS_WITH(KnownFailures(t / "known.toml"), Contains("known.toml:2: worst: found nothing"));
  observe::replace_file(t / "known.toml", entry + "reason = \"noise\"\nworst = 0\n");
  CHECK_THROWS_WITH(KnownFailures(t / "known.toml"), Contains("worst: found 0; allowed a number > 0"));
  observe::replace_file(t / "broken.toml", "[[failure\n");
  CHECK_THROWS_AS(KnownFailures(t / "broken.toml"), UsageError);
}

TEST_CASE("a series judges its finest resolution and gives the observed orders") {
  Rows rows;
  add_series(rows, {4, 2, 1}, {row("a", "x", 1.6), row("a", "x", 0.4), row("a", "x", 0.2)});
  REQUIRE(rows.size() == 3);
  CHECK_FALSE(rows[0].judged);
  CHECK_FALSE(rows[0].order);
  CHECK(rows[1].order.value() == Approx(2.0));
  CHECK(rows[2].order.value() == Approx(1.0));
  CHECK(rows[2].judged);
}
