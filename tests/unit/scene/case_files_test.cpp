// SPDX-License-Identifier: MIT
#include <unistd.h>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "meltray/core/errors.hpp"
#include "meltray/scene/case_file.hpp"
#include "unit/scene/case_samples.hpp"

using meltray::UsageError;
using meltray::scene::read_case;
using namespace case_samples;
namespace fs = std::filesystem;

namespace {

/// A folder of case files that goes away with the test.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("meltray-case-" + std::to_string(::getpid()))) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  fs::path write(const std::string& name, const std::string& text) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string message(const fs::path& file) {
  try {
    read_case(file);
  } catch (const UsageError& e) {
    return e.what();
  }
  return "(accepted)";
}

using Catch::Contains;

}  // namespace

TEST_CASE("case file: the including file overrides its base, --set overrides both") {
  const Folder folder;
  folder.write("parts/base.toml", weld);
  const auto file =
      folder.write("case.toml", "title = \"mine\"\ninclude = \"parts/base.toml\"\n[laser]\npower_w = 2000\n");
  const auto scene = read_case(file);
  CHECK(scene.title == "mine");
  CHECK(scene.laser->beam.power == 2000);
  CHECK(scene.domain.spacing == 5e-5);
  const auto set =
      read_case(file, {"laser.power_w=500", "laser.profile=top_hat", "bodies.0.temperature_k=600"});
  CHECK(set.laser->beam.power == 500);
  CHECK(set.laser->beam.profile == meltray::laser::Profile::top_hat);
  CHECK(set.domain.bodies.at(0).temperature == 600);
  CHECK(meltray::scene::case_title(file) == "mine");
}

TEST_CASE("case file: of several bases the later one wins, bodies replace those of the base") {
  const Folder folder;
  folder.write("a.toml", weld);
  folder.write("b.toml", "[laser]\nrays = 77\n[time]\nend_s = 5e-4\n");
  const auto file =
      folder.write("case.toml",
                   "include = [\"a.toml\", \"b.toml\"]\n[[bodies]]\nshape = \"ball\"\ncenter_m = [5e-4, 0, "
                   "-4e-4]\nradii_m = [2e-4, 2e-4, 2e-4]\n");
  const auto scene = read_case(file);
  CHECK(scene.laser->trace.rays == 77);
  CHECK(scene.time.end == 5e-4);
  REQUIRE(scene.domain.bodies.size() == 1);
  CHECK(scene.domain.bodies[0].shape == meltray::scene::ShapeKind::ball);
}

TEST_CASE("case file: a later layer may switch off what a base set, the same file may not") {
  const Folder folder;
  const std::string base =
      added(weld, "terms", "interface_viscosity = true") + "[flow]\nreference_speed_m_s = 50.0\n";
  folder.write("base.toml", base);
  const auto off =
      folder.write("off.toml", "include = \"base.toml\"\n[terms]\ninterface_viscosity = false\n");
  CHECK_FALSE(read_case(off).terms.interface_viscosity);
  CHECK_FALSE(
      read_case(folder.path() / "base.toml", {"terms.interface_viscosity=false"}).terms.interface_viscosity);
  const auto both =
      folder.write("both.toml", replaced(base, "interface_viscosity = true", "interface_viscosity = false"));
  CHECK_THAT(message(both), Contains("flow.reference_speed_m_s") && Contains("has no effect here"));
}

TEST_CASE("case file: an error in an included file names that file") {
  const Folder folder;
  folder.write("base.toml", replaced(weld, "power_w = 1000", "power_w = -1"));
  const auto file = folder.write("case.toml", "include = \"base.toml\"\n");
  CHECK_THAT(message(file), Contains("base.toml:27: laser.power_w: found -1"));
}

TEST_CASE("case file: missing and unreadable files") {
  const Folder folder;
  CHECK_THAT(message(folder.path() / "none.toml"), Contains("none.toml: found no such file"));
  CHECK_THAT(message(folder.path()), Contains("found a folder"));
  const auto file = folder.write("case.toml", "title = \"x\"\ninclude = \"gone.toml\"\n");
  CHECK_THAT(message(file), Contains("case.toml:2: include: found no such file") && Contains("gone.toml"));
  const auto typed = folder.write("typed.toml", "include = 3\n");
  CHECK_THAT(message(typed), Contains("typed.toml:1: include: found 3; allowed a path"));
  const auto folder_included = folder.write("folder.toml", "include = \".\"\n");
  CHECK_THAT(message(folder_included), Contains("folder.toml:1: include: found a folder"));
}

TEST_CASE("case file: include cycles") {
  const Folder folder;
  const auto self = folder.write("self.toml", "include = \"self.toml\"\n");
  CHECK_THAT(message(self), Contains("self.toml:1: include: found a cycle: self.toml -> self.toml"));
  const auto a = folder.write("a.toml", "title = \"a\"\n\ninclude = \"b.toml\"\n");
  folder.write("b.toml", "include = [\"c.toml\"]\n");
  folder.write("c.toml", "include = \"./a.toml\"\n");
  CHECK_THAT(message(a), Contains("c.toml:1: include: found a cycle: a.toml -> b.toml -> c.toml -> a.toml"));
  const auto other = folder.write("other.toml", "include = \"b.toml\"\n");
  CHECK_THAT(message(other), Contains("found a cycle"));
}

TEST_CASE("case file: a power table from a CSV file beside the case file") {
  const Folder folder;
  const std::string table =
      replaced(weld, "power_w = 1000", "modulation = \"table\"\npower_table = \"data/p.csv\"");
  folder.write("data/p.csv", "# measured\ntime_s,power_w\n0,100\n1e-3, 250.5\n");
  const auto file = folder.write("case.toml", table);
  const auto scene = read_case(file);
  REQUIRE(scene.laser->beam.table.size() == 2);
  CHECK(scene.laser->beam.table[1] == std::pair(1e-3, 250.5));
  const auto bad = [&](const std::string& text) {
    folder.write("data/p.csv", text);
    return message(file);
  };
  CHECK_THAT(bad("time,power\n0,1\n"), Contains("p.csv line 1: 'time,power'") && Contains("time_s,power_w"));
  CHECK_THAT(bad("time_s,power_w\n0,1\n0,2\n"), Contains("p.csv line 3: time 0 s after 0 s"));
  CHECK_THAT(bad("time_s,power_w\n0,1\n1,abc\n"), Contains("p.csv line 3") && Contains("two numbers"));
  CHECK_THAT(bad("time_s,power_w\n0,-1\n"), Contains("power -1 W"));
  CHECK_THAT(bad("time_s,power_w\n0,nan\n"), Contains("finite"));
  CHECK_THAT(bad("time_s,power_w\n"), Contains("no rows"));
}

TEST_CASE("case file: every shipped case reads, alone and resolved") {
  const fs::path cases = fs::path(__FILE__).parent_path() / "../../../cases";
  int count = 0;
  for (const auto& item : fs::directory_iterator(cases)) {
    if (item.path().extension() != ".toml" || meltray::scene::case_title(item.path()).empty()) continue;
    INFO(item.path().string());
    const std::string resolved = meltray::scene::write_case(read_case(item.path()));
    CHECK(meltray::scene::write_case(meltray::scene::read_case_text(resolved, "resolved")) == resolved);
    ++count;
  }
  CHECK(count >= 7);
}
