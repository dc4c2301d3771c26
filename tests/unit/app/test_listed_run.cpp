// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "app/listed_run.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/observe/files.hpp"
#include "unit/observe/temporary_folder.hpp"

using namespace meltray;

TEST_CASE("a run of a list has the spacing of its own case, not of the list's") {
  const TemporaryFolder t;
  observe::replace_file(t / "case.toml",
                        std::string_view("title = \"x\"\n[domain]\nspacing_m = 8e-06  # [m]\n"));
  CHECK(app::spacing_of(t / ".") == 8e-6);
  observe::replace_file(t / "case.toml", std::string_view("title = \"x\"\n"));
  CHECK(app::spacing_of(t / ".") == 0);
  observe::replace_file(t / "case.toml", std::string_view("[domain\n"));
  CHECK_THROWS_AS(app::spacing_of(t / "."), UsageError);
  CHECK_THROWS_AS(app::spacing_of(t / "none"), UsageError);
}
