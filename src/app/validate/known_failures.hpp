// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "app/validate/row.hpp"

namespace meltray::app {

/// Rows that are known to miss their pass line, with the reason found: validation/known_failures.toml, a list
/// of
///   [[failure]]
///   id, quantity, reason = texts; `quantity` as the row has it, with one "*" for anything
///   worst = largest error, in the unit of the row's, that is still the known failure
class KnownFailures {
 public:
  /// Throws UsageError where the file is no such list, with its line.
  explicit KnownFailures(const std::filesystem::path& file);
  /// Writes the reason into every row that failed and is on the list, unless it is worse than the list says.
  void mark(Rows& rows) const;

 private:
  struct Failure {
    std::string id, quantity, reason;
    double worst;
  };
  std::vector<Failure> failures_;
};

}  // namespace meltray::app
