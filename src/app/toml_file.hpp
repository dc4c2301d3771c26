// SPDX-License-Identifier: MIT
#pragma once

#include <toml++/toml.h>

#include <filesystem>

namespace meltray::app {

/// A TOML file as it stands. Throws UsageError with file, line and reason where it cannot be read.
toml::table read_toml(const std::filesystem::path& file);

}  // namespace meltray::app
