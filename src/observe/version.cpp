// SPDX-License-Identifier: MIT
#include "meltray/observe/version.hpp"

#include "git_hash.hpp"

namespace meltray::observe {

std::string version() {
  const std::string hash = MELTRAY_GIT_HASH;
  return std::string(MELTRAY_VERSION) + (hash.empty() ? "" : " (git " + hash + ")");
}

}  // namespace meltray::observe
