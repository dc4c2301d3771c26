// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <random>

#include "meltray/core/errors.hpp"
#include "meltray/observe/checkpoint.hpp"
#include "meltray/observe/files.hpp"
#include "meltray/observe/hdf5_file.hpp"
#include "unit/observe/temporary_folder.hpp"

using namespace meltray;
using namespace meltray::observe;
using Catch::Contains;

namespace {

struct State {
  double t = 0.1;
  std::int64_t steps = 42;
  std::string name = "sine";
  std::vector<double> h = {1, 2.5, 1e-300};
  std::vector<std::uint8_t> flags = {1, 2, 3};
  std::vector<std::int32_t> empty;
  void archive(Archive& a) {
    a.value("t", t);
    a.value("steps", steps);
    a.value("name", name);
    a.values("particles/h", h);
    a.values("particles/flags", flags);
    a.values("empty", empty);
  }
};

void write(const std::filesystem::path& file, double time = 0.5, bool scheduled = true) {
  State state;
  write_checkpoint(file, {"run-1", "0.1", time, 42, scheduled}, [&](Archive& a) { state.archive(a); });
}

void overwrite(const std::filesystem::path& file, const std::vector<std::byte>& bytes) {
  replace_file(file, bytes);
}

}  // namespace

TEST_CASE("a checkpoint gives the state back bit for bit") {
  TemporaryFolder folder;
  write(folder / "c.h5");
  auto c = open_checkpoint(folder / "c.h5", "run-1");
  CHECK(c.header.time == 0.5);
  CHECK(c.header.step == 42);
  CHECK(c.header.scheduled);
  State state{0, 0, "", {}, {}, {7}};
  state.archive(*c.archive);
  CHECK(state.t == 0.1);
  CHECK(state.steps == 42);
  CHECK(state.name == "sine");
  CHECK(state.h == std::vector<double>{1, 2.5, 1e-300});
  CHECK(state.flags == std::vector<std::uint8_t>{1, 2, 3});
  CHECK(state.empty.empty());
  CHECK_FALSE(std::filesystem::exists(folder / "c.h5.part"));
}

TEST_CASE("damaged and foreign checkpoints are refused by name") {
  TemporaryFolder folder;
  const auto file = folder / "checkpoint-a.h5";
  write(file);
  const auto good = read_bytes(file);

  SECTION("truncated at any length") {
    for (const std::size_t keep :
         {std::size_t{100}, std::size_t{511}, std::size_t{512}, good.size() / 2, good.size() - 1}) {
      overwrite(file, {good.begin(), good.begin() + static_cast<std::ptrdiff_t>(keep)});
      CHECK_THROWS_WITH(open_checkpoint(file, "run-1"), Contains("checkpoint-a.h5") && Contains("truncated"));
    }
  }
  SECTION("empty") {
    overwrite(file, {});
    CHECK_THROWS_WITH(open_checkpoint(file, "run-1"), Contains("empty file"));
  }
  SECTION("one flipped bit anywhere") {
    std::mt19937 random(1);
    for (int n = 0; n < 300; ++n) {
      auto bad = good;
      const std::size_t at = n < 120 ? static_cast<std::size_t>(n) : random() % bad.size();
      bad[at] ^= std::byte{static_cast<unsigned char>(1U << random() % 8)};
      overwrite(file, bad);
      CHECK_THROWS_AS(open_checkpoint(file, "run-1"), UsageError);
    }
    auto bad = good;
    bad[good.size() / 2] ^= std::byte{4};
    overwrite(file, bad);
    CHECK_THROWS_WITH(open_checkpoint(file, "run-1"), Contains("checksum"));
  }
  SECTION("bytes behind the end") {
    auto bad = good;
    bad.push_back(std::byte{0});
    overwrite(file, bad);
    CHECK_THROWS_AS(open_checkpoint(file, "run-1"), UsageError);
  }
  SECTION("another schema") {
    std::string text = read_text(file);
    text.replace(text.find("schema 3"), 8, "schema 7");
    replace_file(file, std::string_view(text));
    CHECK_THROWS_WITH(open_checkpoint(file, "run-1"), Contains("schema 7") && Contains("reads schema 3"));
  }
  SECTION("not HDF5, and HDF5 of another kind") {
    replace_file(file, std::string_view("once upon a time"));
    CHECK_THROWS_WITH(open_checkpoint(file, "run-1"), Contains("not a Meltray checkpoint"));
    Hdf5Writer other;
    other.scalar("x", 1.0);
    replace_file(file, other.image());
    CHECK_THROWS_WITH(open_checkpoint(file, "run-1"), Contains("another kind"));
  }
  SECTION("of another run") {
    CHECK_THROWS_WITH(open_checkpoint(file, "run-2"), Contains("another run"));
  }
  SECTION("missing") {
    CHECK_THROWS_AS(open_checkpoint(folder / "none.h5", "run-1"), IoError);
  }
}

TEST_CASE("an HDF5 reader without knowledge of ours finds the file behind the block") {
  TemporaryFolder folder;
  write(folder / "c.h5");
  const Hdf5Reader in(read_bytes(folder / "c.h5"), "c.h5");
  double t = 0;
  in.scalar("state/t", t);
  CHECK(t == 0.1);
}

TEST_CASE("checkpoints alternate and the newest valid one is found") {
  TemporaryFolder folder;
  CheckpointSlots slots(folder.path(), "run-1");
  State state;
  const auto save = [&](double time, bool scheduled) {
    slots.write({"", "0.1", time, 1, scheduled}, [&](Archive& a) { state.archive(a); });
  };
  std::vector<std::string> warnings;
  CHECK_FALSE(slots.newest(true, warnings).has_value());
  save(1, true);
  save(2, true);
  CHECK(slots.newest(true, warnings)->header.time == 2);
  save(3, true);
  CHECK(slots.newest(true, warnings)->header.time == 3);
  CHECK(open_checkpoint(slots.file(1), "run-1").header.time == 2);

  SECTION("a damaged newest one is passed over, with a warning") {
    auto bytes = read_bytes(slots.file(0));
    bytes[bytes.size() - 8] ^= std::byte{1};
    replace_file(slots.file(0), bytes);
    CHECK(slots.newest(true, warnings)->header.time == 2);
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0], Contains("checkpoint-a.h5"));
    // The next one replaces the damaged file, not the good one.
    save(4, true);
    CHECK(open_checkpoint(slots.file(0), "run-1").header.time == 4);
    CHECK(open_checkpoint(slots.file(1), "run-1").header.time == 2);
  }
  SECTION("an unscheduled one never replaces the newest scheduled one") {
    save(3.2, false);
    save(3.4, false);
    CHECK(slots.newest(true, warnings)->header.time == 3);
    CHECK(slots.newest(false, warnings)->header.time == 3.4);
  }
  SECTION("both damaged: every complaint is told") {
    replace_file(slots.file(0), std::string_view("a"));
    replace_file(slots.file(1), std::string_view("b"));
    CHECK_THROWS_WITH(slots.newest(true, warnings),
                      Contains("checkpoint-a.h5") && Contains("checkpoint-b.h5"));
  }
}
