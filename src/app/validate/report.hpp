// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "app/validate/row.hpp"

namespace meltray::app {

void print_header();
/// One line per row on standard output.
void print_rows(const Rows& rows);
/// {"schema_version", "version", "passed", "rows": [...]}. Throws IoError.
void write_json(const std::filesystem::path& file, const Rows& rows);

}  // namespace meltray::app
