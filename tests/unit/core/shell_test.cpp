// SPDX-License-Identifier: MIT
#include "meltray/core/shell.hpp"

#include <catch2/catch.hpp>

using namespace meltray;

TEST_CASE("shell: plain words stay as they are") {
  for (const char* word : {"runs/weld-002", "time.end_s=1e-5", "../a_b@c%d+e:f,g", "0"})
    CHECK(shell_word(word) == word);
}

TEST_CASE("shell: all other words are quoted") {
  CHECK(shell_word("") == "''");
  CHECK(shell_word("my runs/weld") == "'my runs/weld'");
  CHECK(shell_word("surface.temperature=\"face\"") == "'surface.temperature=\"face\"'");
  CHECK(shell_word("domain.min_m=[0, 0, -1e-3]") == "'domain.min_m=[0, 0, -1e-3]'");
  CHECK(shell_word("~/$HOME") == "'~/$HOME'");
  CHECK(shell_word("a\nb") == "'a\nb'");
  CHECK(shell_word("S\xc3\xa4ule") == "'S\xc3\xa4ule'");
}

TEST_CASE("shell: a quote stands outside the quotes") {
  CHECK(shell_word("it's") == "'it'\\''s'");
  CHECK(shell_word("'") == "''\\'''");
}
