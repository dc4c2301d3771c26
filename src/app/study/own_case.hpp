// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "app/study/catalogue.hpp"
#include "app/study/cells.hpp"

namespace meltray::app::studies {

/// A case file of one's own as a scene of the map of stability.
StudyScene own_case(const std::filesystem::path& case_file);
/// The same for the studies that compare steps: measured are depths and absorbed energy of a weld, else
/// velocities and temperatures, whichever it has; the fixed steps begin at twice the mean step of the case as
/// it is, which is run for that. Welds on a jittered lattice are compared by means over five seeds.
StudyScene own_case_in_steps(const std::filesystem::path& case_file, Cells& cells);

}  // namespace meltray::app::studies
