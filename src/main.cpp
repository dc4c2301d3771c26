// SPDX-License-Identifier: MIT
#include "meltray/app/command_line.hpp"

int main(int argc, char** argv) { return meltray::app::run_command_line(argc, argv); }
