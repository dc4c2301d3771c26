// SPDX-License-Identifier: MIT
#pragma once

namespace meltray::app {

/// Turns the first SIGINT or SIGTERM into a request that the run loop reads after each step; a second one
/// ends the process at once. Files are replaced in one step each, so even that spoils nothing.
void catch_signals();
/// SIGINT, SIGTERM, or 0.
int requested_signal();

}  // namespace meltray::app
