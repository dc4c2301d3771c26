// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <limits>

#include "meltray/core/errors.hpp"
#include "meltray/core/vec.hpp"

namespace meltray::sph {

/// Throws NumericalFailure where a list has more entries than an Index tells apart.
inline void require_indexable(std::int64_t entries, const char* list) {
  if (entries > std::numeric_limits<Index>::max())
    throw NumericalFailure(
        fmt::format("{}: {} entries, more than 32-bit numbers can tell apart: fewer particles or a smaller "
                    "domain.smoothing_ratio",
                    list, entries));
}

}  // namespace meltray::sph
