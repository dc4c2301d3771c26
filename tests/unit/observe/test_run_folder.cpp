// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "meltray/core/errors.hpp"
#include "meltray/observe/files.hpp"
#include "meltray/observe/run_folder.hpp"
#include "unit/observe/temporary_folder.hpp"

using namespace meltray;
using namespace meltray::observe;
namespace fs = std::filesystem;
using Catch::Contains;

namespace {

RunFolder::Options in(const fs::path& out, bool overwrite = false) {
  return {out, overwrite, "weld", "runs"};
}

void set_outcome(const fs::path& folder, const char* outcome) {
  replace_file(folder / "summary.json", std::string("{\"outcome\": \"") + outcome + "\"}");
}

}  // namespace

TEST_CASE("default folders are numbered") {
  TemporaryFolder t;
  RunFolder::Options o;
  o.case_name = "weld";
  o.runs = t / "runs";
  CHECK(RunFolder::create(o).path() == t / "runs/weld");
  CHECK(RunFolder::create(o).path() == t / "runs/weld-002");
  CHECK(RunFolder::create(o).path() == t / "runs/weld-003");
}

TEST_CASE("every run has its own id, which its folder keeps") {
  TemporaryFolder t;
  std::string a;
  {
    const auto folder = RunFolder::create(in(t / "a"));
    a = folder.run_id();
  }
  CHECK(a.size() == 16);
  CHECK(RunFolder::open(t / "a").run_id() == a);
  CHECK(RunFolder::create(in(t / "b")).run_id() != a);
}

TEST_CASE("an explicit folder that is not empty is refused") {
  TemporaryFolder t;
  const fs::path out = t / "out";
  SECTION("empty: taken") {
    fs::create_directory(out);
    CHECK_NOTHROW(RunFolder::create(in(out)));
  }
  SECTION("foreign: refused with and without --overwrite, nothing touched") {
    fs::create_directory(out);
    replace_file(out / "history.csv", std::string_view("mine"));
    CHECK_THROWS_WITH(RunFolder::create(in(out)), Contains("not a run folder"));
    CHECK_THROWS_AS(RunFolder::create(in(out, true)), UsageError);
    CHECK(read_text(out / "history.csv") == "mine");
  }
  SECTION("unfinished: answered with the resume command") {
    { RunFolder::create(in(out)); }
    set_outcome(out, "running");
    CHECK_THROWS_WITH(RunFolder::create(in(out)),
                      Contains("unfinished") && Contains("meltray resume " + out.string()));
  }
  SECTION("unfinished: the resume command can be pasted") {
    const fs::path spaced = t / "my run";
    { RunFolder::create(in(spaced)); }
    CHECK_THROWS_WITH(RunFolder::create(in(spaced)), Contains("meltray resume '" + spaced.string() + "'"));
  }
  SECTION("finished: --overwrite replaces what a run writes and nothing else") {
    { RunFolder::create(in(out)); }
    set_outcome(out, "finished");
    replace_file(out / "history.csv", std::string_view("old"));
    replace_file(out / "notes.txt", std::string_view("mine"));
    CHECK_THROWS_WITH(RunFolder::create(in(out)), Contains("--overwrite"));
    const auto folder = RunFolder::create(in(out, true));
    CHECK_FALSE(fs::exists(out / "history.csv"));
    CHECK_FALSE(fs::exists(out / "summary.json"));
    CHECK(read_text(out / "notes.txt") == "mine");
  }
  SECTION("a file is no folder") {
    replace_file(out, std::string_view("x"));
    CHECK_THROWS_WITH(RunFolder::create(in(out, true)), Contains("not a folder"));
  }
}

TEST_CASE("two processes never work in one folder") {
  TemporaryFolder t;
  const auto first = RunFolder::create(in(t / "a"));
  // flock() belongs to the open file, so a second opening in this process is refused like another process.
  CHECK_THROWS_WITH(RunFolder::open(t / "a"), Contains("another meltray process"));
  CHECK_THROWS_WITH(RunFolder::create(in(t / "a", true)), Contains("another meltray process"));
}

TEST_CASE("what is no run folder is not opened") {
  TemporaryFolder t;
  CHECK_THROWS_WITH(RunFolder::open(t / "none"), Contains("no such run folder"));
  CHECK_THROWS_WITH(RunFolder::open(t.path()), Contains("not a run folder"));
}

TEST_CASE("a file is replaced as a whole or not at all") {
  TemporaryFolder t;
  replace_file(t / "f", std::string_view("one"));
  replace_file(t / "f", std::string_view("two"));
  CHECK(read_text(t / "f") == "two");
  CHECK_THROWS_AS(replace_file(t / "none/f", std::string_view("x")), IoError);
  // A folder in the way makes the rename fail: the part file is cleaned up.
  fs::create_directories(t / "d/inside");
  CHECK_THROWS_AS(replace_file(t / "d", std::string_view("x")), IoError);
  CHECK_FALSE(fs::exists(t / "d.part"));
}

TEST_CASE("what cannot be written is known before") {
  TemporaryFolder t;
  CHECK_NOTHROW(check_writable(t / "f"));
  CHECK_FALSE(fs::exists(t / "f"));
  write_file(t / "f", "longer");
  write_file(t / "f", "text");
  CHECK(read_text(t / "f") == "text");
  CHECK_NOTHROW(check_writable(t / "f"));
  CHECK_NOTHROW(check_writable("/dev/null"));
  CHECK_NOTHROW(write_file("/dev/null", "text"));
  CHECK_THROWS_WITH(check_writable(t / "none/f"), Contains((t / "none/f").string()));
  CHECK_THROWS_AS(write_file(t / "none/f", "text"), IoError);
  CHECK_THROWS_AS(check_writable(t / "f/f"), IoError);  // a file in place of the folder
  CHECK_THROWS_AS(check_writable(t.path()), IoError);
}
