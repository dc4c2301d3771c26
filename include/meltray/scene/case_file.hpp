// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "meltray/scene/scene.hpp"

namespace meltray::scene {

/// "section.key=value" overrides from the command line; the value is TOML (bare words are taken as strings).
using Overrides = std::vector<std::string>;

/// Reads a case file with its includes and overrides, checks every key, and fills in every default.
/// Throws UsageError: "<file>:<line>: <key>: found <x>; allowed <y>" with the nearest known key where one is
/// unknown. Paths inside a case file are relative to that file.
Scene read_case(const std::filesystem::path& file, const Overrides& overrides = {});

/// The title of a case file, without a check of the rest; empty where there is none (a base for `include`).
std::string case_title(const std::filesystem::path& file);

/// The scene as a case file with every key, defaults included; read_case() of the text gives the same scene.
std::string write_case(const Scene& scene);

/// Keys and values of write_case() alone, which no change of its comments changes: to tell cases apart.
std::string case_values(const Scene& scene);

/// read_case() of a text; `name` stands for the file in messages. Used for case.toml inside checkpoints.
Scene read_case_text(const std::string& text, const std::string& name, const Overrides& overrides = {});

/// Declared keys as a Markdown reference page (name, type, unit, default, allowed range, one sentence).
std::string key_reference();

}  // namespace meltray::scene
