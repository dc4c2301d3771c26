// SPDX-License-Identifier: MIT
#pragma once

namespace meltray::app {

/// Parses the command line, runs the command, reports errors, and returns the exit code of the contract.
int run_command_line(int argc, char** argv);

}  // namespace meltray::app
