// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace meltray::app {

/// Runs a Python script of the folder scripts/ and returns 0, or the exit code of the contract. Throws
/// UsageError where the script is missing and IoError where Python is.
int run_script(const char* name, const std::vector<std::string>& arguments);

}  // namespace meltray::app
