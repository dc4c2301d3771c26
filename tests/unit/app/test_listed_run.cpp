// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "app/listed_run.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/observe/files.hpp"
#include "unit/observe/temporary_folder.hpp"

using namespace meltray;

TEST_CASE("the command of a run can be pasted into a shell") {
  const TemporaryFolder t;
  app::ListedRun plain{"cases/weld.toml", t / "weld-1", {"laser.power_w=500"}, 1e-3};
  CHECK(app::command_of(plain) == "meltray run cases/weld.toml --out " + (t / "weld-1").string() +
                                      " --until 0.001 --set laser.power_w=500");
  const std::string folder = "'" + (t / "my welds").string() + "'";
  app::ListedRun spaced{"it's.toml", t / "my welds", {"surface.temperature=\"face\""}, 1e-3};
  CHECK(app::command_of(spaced) == "meltray run 'it'\\''s.toml' --out " + folder +
                                       " --until 0.001 --set 'surface.temperature=\"face\"'");
  std::filesystem::create_directory(spaced.folder);
  observe::replace_file(spaced.folder / ".meltray-run", std::string_view("{}"));
  CHECK(app::command_of(spaced) == "meltray resume " + folder + " --until 0.001");
}

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
