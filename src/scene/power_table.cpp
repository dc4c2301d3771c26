// SPDX-License-Identifier: MIT
#include "scene/power_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "scene/keys.hpp"

namespace meltray::scene {

namespace {

using PowerTable = std::vector<std::pair<double, double>>;

std::string trimmed(const std::string& text) {
  const auto begin = text.find_first_not_of(" \t\r");
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

bool parse(const std::string& text, double& x) {
  const std::string cell = trimmed(text);
  char* end = nullptr;
  x = std::strtod(cell.c_str(), &end);
  return !cell.empty() && *end == '\0';
}

/// `where` names the row in messages.
void check_row(const PowerTable& table, const std::string& where) {
  const auto& [time, power] = table.back();
  if (!std::isfinite(time) || !std::isfinite(power))
    throw Refusal{fmt::format("{}: {}, {}", where, time, power), "finite numbers", {}};
  if (power < 0) throw Refusal{fmt::format("{}: power {} W", where, power), "power >= 0", {}};
  if (table.size() > 1 && time <= table[table.size() - 2].first)
    throw Refusal{fmt::format("{}: time {} s after {} s", where, time, table[table.size() - 2].first),
                  "times that rise from row to row",
                  {}};
}

PowerTable from_file(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::error_code ignored;
  if (!file || std::filesystem::is_directory(path, ignored))
    throw Refusal{
        fmt::format("no readable file at '{}'", path.string()), "a CSV file with columns time_s,power_w", {}};
  PowerTable table;
  std::string line;
  bool header = false;
  for (int row = 1; std::getline(file, line); ++row) {
    if (row == 1 && line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);  // of spreadsheets: a byte order mark
    line = trimmed(line);
    if (line.empty() || line[0] == '#') continue;
    const std::string where = fmt::format("{} line {}", path.filename().string(), row);
    if (!header) {
      std::string names = line;
      std::erase(names, ' ');
      if (names != "time_s,power_w")
        throw Refusal{fmt::format("{}: '{}'", where, line), "the header time_s,power_w", {}};
      header = true;
      continue;
    }
    const auto comma = line.find(',');
    double time = 0, power = 0;
    if (comma == std::string::npos || !parse(line.substr(0, comma), time) ||
        !parse(line.substr(comma + 1), power))
      throw Refusal{fmt::format("{}: '{}'", where, line), "two numbers: time_s,power_w", {}};
    table.emplace_back(time, power);
    check_row(table, where);
  }
  if (table.empty()) throw Refusal{fmt::format("no rows in '{}'", path.string()), "at least one row", {}};
  return table;
}

PowerTable from_array(const Array& rows, const std::string& allowed) {
  PowerTable table;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Array* row = rows[k].array();
    if (!row || row->size() != 2 || !(*row)[0].is_number() || !(*row)[1].is_number())
      throw Refusal{describe(rows[k]), allowed, {}};
    table.emplace_back((*row)[0].number(), (*row)[1].number());
    check_row(table, fmt::format("row {}", k + 1));
  }
  if (table.empty()) throw Refusal{"an empty array", "at least one row", {}};
  return table;
}

}  // namespace

PowerTable read_power_table(const Entry& entry, const std::string& allowed) {
  if (const Array* rows = entry.value.array()) return from_array(*rows, allowed);
  const std::string* path = entry.value.text();
  if (!path || path->empty()) throw Refusal{describe(entry.value), allowed, {}};
  return from_file(entry.folder / *path);
}

}  // namespace meltray::scene
