// SPDX-License-Identifier: MIT
#include "app/toml_file.hpp"

#include <fmt/format.h>

#include "meltray/core/errors.hpp"

namespace meltray::app {

toml::table read_toml(const std::filesystem::path& file) {
  try {
    return toml::parse_file(file.string());
  } catch (const toml::parse_error& e) {
    throw UsageError(fmt::format("{}:{}: {}", file.string(), e.source().begin.line, e.description()));
  }
}

}  // namespace meltray::app
