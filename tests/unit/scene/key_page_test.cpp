// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "meltray/scene/case_file.hpp"

TEST_CASE("the reference page of the keys is what the declarations say") {
  const auto root = std::filesystem::path(__FILE__).parent_path() / "../../..";
  std::ifstream file(root / "cases/KEYS.md");
  REQUIRE(file);
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  // Write it anew with: build/release/meltray list keys > cases/KEYS.md
  CHECK(page == meltray::scene::key_reference());
}
