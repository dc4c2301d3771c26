// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace meltray::app {

/// A reference table: CSV with one line of column names; lines that start with `#` are comments, of which
/// `# source: ...` tells where the numbers come from.
class Table {
 public:
  /// Throws IoError where the file cannot be read and UsageError where it is no such table.
  explicit Table(const std::filesystem::path& file);
  std::size_t rows() const { return cells_.size(); }
  const std::string& source() const { return source_; }
  const std::string& text(std::size_t row, const std::string& column) const;
  double number(std::size_t row, const std::string& column) const;

 private:
  std::filesystem::path file_;
  std::string source_;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> cells_;
};

}  // namespace meltray::app
