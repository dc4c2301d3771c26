// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace meltray::observe {

/// "0.1.0 (git 1a2b3c4)", or without the part in brackets where it was built outside a repository.
std::string version();

}  // namespace meltray::observe
