// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace meltray::app {

/// Folder of the repository that the program reads at run time, such as "scripts": the environment variable
/// `variable` where it is set, else the folder of the repository that the program was built in
/// (build/<preset>/meltray), else that of the sources.
std::filesystem::path repository_folder(const char* name, const char* variable);

}  // namespace meltray::app
