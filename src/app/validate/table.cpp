// SPDX-License-Identifier: MIT
#include "app/validate/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>

#include "meltray/core/errors.hpp"

namespace meltray::app {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells{""};
  for (const char c : line) {
    if (c == ',')
      cells.emplace_back();
    else if (c != '\r')
      cells.back() += c;
  }
  return cells;
}

}  // namespace

Table::Table(const std::filesystem::path& file) : file_(file) {
  std::ifstream in(file);
  if (!in)
    throw IoError(fmt::format(
        "{}: cannot be read; MELTRAY_VALIDATION names the folder of the validation cases", file.string()));
  const std::string mark = "# source: ";
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with(mark)) source_ = line.substr(mark.size());
    if (line.empty() || line[0] == '#') continue;
    if (columns_.empty())
      columns_ = split(line);
    else
      cells_.push_back(split(line));
    if (!cells_.empty() && cells_.back().size() != columns_.size())
      throw UsageError(fmt::format("{}: found {} cells in row {}; allowed {}", file.string(),
                                   cells_.back().size(), cells_.size(), columns_.size()));
  }
  if (source_.empty() || cells_.empty())
    throw UsageError(fmt::format("{}: found no source line or no row; allowed '# source: ...' and a table",
                                 file.string()));
}

const std::string& Table::text(std::size_t row, const std::string& column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (found == columns_.end())
    throw UsageError(fmt::format("{}: has no column '{}'", file_.string(), column));
  return cells_.at(row)[static_cast<std::size_t>(found - columns_.begin())];
}

double Table::number(std::size_t row, const std::string& column) const {
  const std::string& cell = text(row, column);
  double value = 0;
  const auto end = cell.data() + cell.size();
  const auto result = std::from_chars(cell.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end)
    throw UsageError(
        fmt::format("{}: found '{}' in column {}; allowed a number", file_.string(), cell, column));
  return value;
}

}  // namespace meltray::app
