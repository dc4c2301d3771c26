// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace meltray {

/// Exit codes of the command line (the contract with the user).
enum ExitCode {
  kExitOk = 0,
  kExitValidationFailed = 1,
  kExitUsage = 2,
  kExitNumerical = 3,
  kExitIo = 4,
  kExitInterrupted = 130,
  kExitTerminated = 143
};

/// The user asked for something that cannot be done as written (case file, option, damaged input): exit 2.
/// The message is complete: file, line, key, what was found, what is allowed.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The computation failed: exit 3. The message says what, where, at which time, which particle and term.
struct NumericalFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reading or writing failed (disk full, read-only, permission): exit 4.
struct IoError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace meltray
